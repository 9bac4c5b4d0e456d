"""Reversals and whole revolutions, found from the angle alone."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import find_strokes, turning_points
from rig.core.units import TURN
from tests.analysis.synthetic import count, slow_run, triangle


def motion(theta: np.ndarray, breaks: tuple[int, ...] = ()) -> Motion:
    return Motion(50.0, theta, theta / 50.0, np.arange(theta.size) * 1e-3, None, breaks)


def test_two_cycles_of_four_turns_give_thirteen_revolutions_forward_and_fourteen_back() -> None:
    """0 → +4 → −4 → +4 → −4 → 0 turns: 3 + 7 + 3 forward and 7 + 7 back, half a turn cut at each end."""
    run = slow_run(0)
    strokes = find_strokes(motion(run.columns["theta_m"]))
    assert [(s.direction, s.revolutions) for s in strokes] == [(1, 3), (-1, 7), (1, 7), (-1, 7), (1, 3)]


def test_every_revolution_is_a_turn_long_and_half_a_turn_away_from_a_reversal() -> None:
    theta = slow_run(1).columns["theta_m"]
    pivots = turning_points(theta, TURN / 4)
    for s, (a, b) in zip(find_strokes(motion(theta)), pairwise(pivots), strict=True):
        turns = np.abs(np.diff(theta[s.edges])) / TURN
        assert np.allclose(turns, 1.0, atol=1e-3)
        for row in (s.edges[0], s.edges[-1]):
            assert min(abs(theta[row] - theta[a]), abs(theta[row] - theta[b])) >= 0.489 * TURN


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(
    pivots=st.lists(st.floats(0.6, 9.0), min_size=1, max_size=6),
    noise=st.floats(0.0, 0.05),
    per_turn=st.integers(500, 70_000),
    seed=st.integers(0, 1000),
)
def test_reversals_are_found_where_they_were_made(pivots: list[float], noise: float, per_turn: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    corners = np.cumsum([0.0, *(p * (-1) ** k for k, p in enumerate(pivots))]) * TURN
    rows = np.concatenate([[0], np.cumsum([int(600 * p) for p in pivots])])
    theta = np.interp(np.arange(rows[-1] + 1), rows, corners) + rng.uniform(-noise, noise, rows[-1] + 1) * TURN
    found = turning_points(count(theta, per_turn), TURN / 4)
    assert len(found) == rows.size
    assert np.all(np.abs(np.array(found) - rows) <= 600 * 2 * noise + 2 + rows[-1] / 4096)


def test_hunting_by_a_tenth_of_a_turn_is_no_reversal() -> None:
    t = np.arange(0, 100.0, 1e-3)
    theta = triangle(t, 4 * TURN, 0.01) + 0.05 * TURN * np.sin(2 * np.pi * 1.0 * t)
    assert len(turning_points(theta, TURN / 4)) == 4


def test_a_run_that_begins_and_ends_in_motion_is_not_cut_there() -> None:
    """A constant-speed run released at speed: 20.3 turns give 20 revolutions, not 19."""
    theta = np.linspace(1.0, 1.0 + 20.3 * TURN, 20_000)
    (stroke,) = find_strokes(motion(theta))
    assert stroke.revolutions == 20


def test_a_run_that_begins_at_rest_is_cut_there() -> None:
    theta = np.concatenate((np.zeros(2000), np.linspace(0.0, 20.3 * TURN, 20_000)))
    (stroke,) = find_strokes(motion(theta))
    assert stroke.revolutions == 19
    assert theta[stroke.edges[0]] >= 0.49 * TURN


@pytest.mark.parametrize("seed", range(12))
def test_where_in_a_rest_noise_is_highest_does_not_tell_whether_it_was_one(seed: int) -> None:
    still, turning = np.zeros(150), np.linspace(0.0, 20.3 * TURN, 20_000)
    theta = np.concatenate((still, turning, still + turning[-1]))
    noisy = theta + 2e-4 * np.random.default_rng(seed).standard_normal(theta.size)
    (stroke,) = find_strokes(motion(noisy))
    assert 0.49 * TURN < theta[stroke.start] < 0.51 * TURN
    assert 0.49 * TURN < turning[-1] - theta[stroke.stop - 1] < 0.51 * TURN


def test_angles_are_not_joined_across_a_new_reference_of_an_encoder() -> None:
    theta = np.linspace(0.0, 20.0 * TURN, 20_000)
    strokes = find_strokes(motion(theta, breaks=(10_000,)))
    assert [s.revolutions for s in strokes] == [9, 9] or [s.revolutions for s in strokes] == [10, 10]
    assert all(s.stop <= 10_000 or s.start >= 10_000 for s in strokes)


@pytest.mark.parametrize("theta", [np.zeros(1000), np.linspace(0, 0.9 * TURN, 1000), np.full(10, 3.0)])
def test_a_motor_that_hardly_moved_has_no_strokes(theta: np.ndarray) -> None:
    assert find_strokes(motion(theta)) == []
