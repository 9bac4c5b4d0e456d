"""A long run is gone through some rows at a time, its columns in files: every figure is what it is in one piece."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.analysis import analyse
from rig.analysis.motion.angle import is_wrapped, unwrap
from rig.analysis.motion.source import motion_of
from rig.core import rows
from rig.core.channels import UNTRUSTED, Flag
from rig.core.units import TURN
from tests.analysis.synthetic import PROFILE, MadeRun, count, triangle


def slow_run(seconds: float, **columns: Any) -> MadeRun:
    """Triangle of ±3 turns, 20 s a cycle; a stretch the guard speaks against, an encoder referenced anew once."""
    t = np.arange(0, seconds, 1e-3)
    reference = triangle(t, 3 * TURN, 0.05)
    theta = reference + 0.002 * np.sin(7.0 * t)
    flags = np.zeros(t.size)
    flags[4000:4007] = int(UNTRUSTED) & -int(UNTRUSTED)
    flags[12_345] = int(Flag.EPOCH)
    made = {
        "t": t,
        "theta_m": count(theta, 65_536),
        "theta_l": count(theta / 50 - PROFILE.value(theta), 1_296_000),
        "theta_ref": reference,
        "tau_l": 2.0 + np.sin(theta / 50),
        "flags": flags,
    }
    return MadeRun({**made, **columns}, {"procedure": "kinematic_error", "gear": {"ratio": 50}})


@pytest.fixture
def long(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run is a long one."""
    monkeypatch.setattr(rows, "LONG", 100)
    monkeypatch.setattr(rows, "STRETCH", 997)


@pytest.fixture
def in_one_piece() -> Any:
    run = slow_run(50.0)
    return run, analyse(run), motion_of(run)


@pytest.mark.slow
def test_figures_and_curves_of_a_run_are_the_same_in_stretches(in_one_piece: Any, long: None) -> None:
    run, whole, _ = in_one_piece
    found = analyse(run)
    assert any(e.name == "kinematic_error_peak_to_peak" for e in found.estimates)
    assert repr(found.estimates) == repr(whole.estimates)
    assert (found.sentence, found.cannot, found.checks) == (whole.sentence, whole.cannot, whole.checks)
    assert found.curves.keys() == whole.curves.keys()
    assert all(np.array_equal(found.curves[k], whole.curves[k], equal_nan=True) for k in whole.curves)


def test_rows_left_out_and_breaks_are_the_same_in_stretches(in_one_piece: Any, long: None) -> None:
    run, _, whole = in_one_piece
    found = motion_of(run)
    assert found is not None
    assert found.rows is not None
    assert np.array_equal(found.rows, whole.rows)
    assert found.rows.size == 50_000 - 7
    assert found.breaks == whole.breaks == (12_345 - 7,)
    assert found.notes == whole.notes


def test_a_time_that_stands_still_where_two_stretches_meet_is_seen(long: None) -> None:
    t = np.arange(0, 50, 1e-3)
    t[997] = t[996]
    motion = motion_of(slow_run(50.0, t=t))
    assert motion is not None
    assert motion.t is None
    assert "does not increase everywhere" in motion.notes[-1]


def test_an_angle_is_unwrapped_across_stretches(long: None) -> None:
    true = np.linspace(0.1, 400.0, 20_000)
    assert is_wrapped(np.mod(true, TURN))
    assert np.allclose(unwrap(np.mod(true, TURN), TURN), true, atol=1e-9)
