"""Rows at which a motor encoder knows its angle no better than to a count."""

import numpy as np

from rig.analysis.tracing.runs.counts import LOCKED, one_a_stay, resting

COUNTS = 10_000
COUNT = 2 * np.pi / COUNTS


def rounded(theta: np.ndarray) -> np.ndarray:
    return COUNT * np.round(theta / COUNT)


def test_a_motor_that_stands_still_rests_but_not_one_that_turns_slowly() -> None:
    t = np.arange(0, 2, 0.004)
    theta = rounded(np.where(t < 1, 1.0, 1.0 + 1.0 * (t - 1)))  # 9.6 rpm from 1 s on
    rest = resting(theta, 0.004, COUNTS, 0.01)
    assert rest[t < 0.95].all()
    assert not rest[t > 1.05].any()


def test_without_known_counts_nothing_rests() -> None:
    assert not resting(np.zeros(100), 0.004, 0.0, 0.01).any()


def test_stick_and_slip_is_one_reading_a_stay() -> None:
    t = np.arange(0, 10, 0.008)
    theta = 0.014 * np.floor(t)  # sticks for 1 s, jumps by 0.8°
    rest = resting(theta, 0.008, COUNTS, LOCKED)
    kept = one_a_stay(rest, 50)
    assert kept.sum() == 10
    assert np.array_equal(np.floor(t[kept]), np.arange(10.0))
    assert rest[kept].all()


def test_a_smooth_motion_between_stays_is_kept_whole() -> None:
    rest = np.array([True] * 40 + [False] * 100 + [True] * 40)
    kept = one_a_stay(rest, 50)
    assert kept[40:140].all()
    assert kept.sum() == 102
