"""Rows that were taken evenly and stamped late, and rows that were stamped when they were taken."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.runs.stamped import evened

DT = 4e-3  # s
ROWS = 5000


def angle(t: np.ndarray) -> np.ndarray:
    """Of a motor that speeds up and slows down, to 60 rad/s, rad."""
    return np.asarray(100.0 * np.sin(0.6 * t) + 0.01 * np.sin(9.0 * t))


@pytest.fixture
def late(rng: np.random.Generator) -> np.ndarray:
    """How late each row is stamped, s."""
    return np.asarray(rng.exponential(6e-4, ROWS))


def test_rows_of_an_even_clock_are_at_their_count(late: np.ndarray) -> None:
    taken = DT * (1 + 2e-5) * np.arange(ROWS)
    t, note = evened(taken + late, angle(taken), DT)
    assert np.std(t - taken) < 0.1 * np.std(late)
    assert "its rows were taken evenly, one every 4 ms" in note


def test_rows_that_were_stamped_as_they_were_taken_stay(late: np.ndarray) -> None:
    taken = DT * np.arange(ROWS) + late
    t, note = evened(taken, angle(taken), DT)
    assert t is taken
    assert note == ""


@pytest.mark.parametrize("digits", [3, 9])  # of the stamps' seconds
@pytest.mark.parametrize("lost", [1, 3])
def test_a_row_that_was_lost_is_not_evened_out(late: np.ndarray, lost: int, digits: int) -> None:
    taken = DT * (np.arange(ROWS) + lost * (np.arange(ROWS) >= 2000))
    t, note = evened(np.round(taken + late, digits), angle(taken), DT)
    assert note
    assert np.max(np.abs(t - taken - np.median(t - taken))) < 0.2 * DT
    assert abs(float(np.median((t - taken)[1900:1990]) - np.median((t - taken)[2010:2100]))) < 1e-4
    assert t[2000] - t[1999] == pytest.approx((1 + lost) * DT, abs=2e-4)


def test_an_angle_that_rests_says_nothing(late: np.ndarray, rng: np.random.Generator) -> None:
    taken = DT * np.arange(ROWS)
    t, note = evened(taken + late, 1e-5 * rng.standard_normal(ROWS), DT)
    assert note == ""
    assert t[-1] == taken[-1] + late[-1]


def test_an_even_clock_and_a_short_run_are_left_alone(late: np.ndarray) -> None:
    taken = DT * np.arange(ROWS)
    assert evened(taken, angle(taken), DT)[1] == ""
    assert evened((taken + late)[:80], angle(taken)[:80], DT)[1] == ""
    assert evened(taken + late, None, DT)[1] == ""
