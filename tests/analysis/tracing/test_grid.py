"""Where rows are missing a run goes on, or is cut."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.runs.grid import joined
from rig.core.units import RPM


@pytest.mark.parametrize(
    ("missing", "rpm", "pieces"),
    [
        (3, 60.0, 1),  # 1.4 degrees of the motor
        (7, 60.0, 1),
        (3, 600.0, 2),  # 14 degrees: an order 15 turns over in it
        (12, 60.0, 2),
    ],
)
def test_a_few_rows_in_which_the_motor_hardly_turned_are_bridged(missing: int, rpm: float, pieces: int) -> None:
    t = np.delete(np.arange(2000) * 1e-3, slice(1000, 1000 + missing))
    found = joined(t, rpm * RPM * t, 1e-3, (), steady=True)
    assert len(found) == pieces
    assert (found[0][0], found[-1][1]) == (0, t.size)


def test_of_a_motor_angle_that_nobody_read_nothing_is_bridged() -> None:
    t = np.delete(np.arange(2000) * 1e-3, slice(1000, 1004))
    assert len(joined(t, np.full(t.size, np.nan), 1e-3, (), steady=True)) == 2
