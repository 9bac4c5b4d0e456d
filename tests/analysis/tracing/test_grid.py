"""Where rows are missing a run goes on, or is cut."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.runs.grid import joined, usual_distance
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


@pytest.mark.parametrize(("rate", "digits"), [(300.0, 3), (300.0, 9), (250.0, 3), (1000.0, 3), (128.0, 3)])
def test_stamps_in_whole_milliseconds_are_no_other_rate(rate: float, digits: int) -> None:
    t = np.round(np.arange(3000) / rate, digits)
    assert usual_distance(t) == pytest.approx(1 / rate, rel=0.01)
    assert usual_distance(np.delete(t, [500, 1500, 1501])) == pytest.approx(1 / rate, rel=0.01)


def test_of_a_clock_that_jitters_the_usual_distance_is_the_middle_one(rng: np.random.Generator) -> None:
    t = np.arange(3000) / 250.0 + rng.exponential(3e-4, 3000)
    assert usual_distance(t) == pytest.approx(4e-3, rel=0.02)
