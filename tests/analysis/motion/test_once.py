"""A row that a logger wrote twice is one row."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.motion.source import motion_of
from rig.core import rows
from tests.analysis.synthetic import MadeRun


def run(*, of: int = 5000, twice: slice = slice(0, 0), theta_l: bool = True) -> MadeRun:
    """A motor at 30 rad/s, `twice` of whose rows stand there once more."""
    at = np.sort(np.concatenate([np.arange(of), np.arange(of)[twice]]))
    t = at * 1e-3
    columns = {"t": t, "theta_m": 30.0 * t, **({"theta_l": 0.6 * t} if theta_l else {})}
    return MadeRun(columns, {"procedure": "other", "gear": {"ratio": 50}})


@pytest.mark.parametrize("twice", [slice(None), slice(990, 1000), slice(0, 1), slice(4999, None)])
@pytest.mark.parametrize("theta_l", [True, False])
def test_rows_that_stand_there_twice_are_taken_once_across_stretches_too(
    twice: slice, theta_l: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rows, "STRETCH", 997)
    once, found = motion_of(run(theta_l=theta_l)), motion_of(run(twice=twice, theta_l=theta_l))
    assert once is not None
    assert found is not None
    assert found.t is not None
    np.testing.assert_array_equal(found.t, once.t)
    np.testing.assert_array_equal(found.theta_m, once.theta_m)
    copies = len(range(*twice.indices(5000)))
    assert found.notes[0] == f"{copies} of {5000 + copies} rows have time and angles of the row before: taken once."
    assert not any("finite" in note for note in found.notes)


def test_rows_that_miss_an_angle_are_counted_beside_those_that_stand_there_twice() -> None:
    made = run(twice=slice(10, 15))
    made.columns["theta_m"][100:103] = np.nan
    found = motion_of(made)
    assert found is not None
    assert found.notes[:2] == (
        "5 of 5005 rows have time and angles of the row before: taken once.",
        "3 of 5005 rows left out: theta_m has no usable value in 3 of them (row 100 to 102).",
    )


def test_a_time_that_stands_still_while_the_motor_turns_is_no_copy() -> None:
    made = run()
    made.columns["t"][1000] = made.columns["t"][999]
    found = motion_of(made)
    assert found is not None
    assert found.t is None
    assert "does not increase everywhere" in found.notes[-1]
