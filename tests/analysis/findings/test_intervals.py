"""Intervals: Student's factor, correlated means, amplitudes near zero, verdicts with a guard band."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.findings.intervals import (
    against_limit,
    amplitude_interval,
    inflation,
    neighbour_correlation,
    rms_of_pieces,
    t95,
)
from rig.analysis.findings.result import Verdict


@pytest.mark.parametrize(
    ("dof", "table"), [(1, 12.706), (4, 2.776), (11, 2.201), (25, 2.060), (60, 2.000), (1e9, 1.960)]
)
def test_student_factor_is_that_of_the_tables(dof: float, table: float) -> None:
    assert np.isclose(t95(dof), table, rtol=1e-3)


def test_the_rms_of_pieces_is_held_by_its_interval_as_often_as_it_says() -> None:
    rng = np.random.default_rng(2)
    held = []
    for _ in range(400):
        x = 0.3 * np.sqrt(rng.gamma(20.0, 1 / 20.0, (27, 1))) * rng.standard_normal((27, 500))  # pieces differ a little
        value, half = rms_of_pieces((x**2).sum(1), np.full(27, 500.0))
        held.append(abs(value - 0.3) <= half)
    assert 0.91 <= np.mean(held) <= 0.98


def test_of_a_single_piece_the_rms_is_known_and_its_interval_is_not() -> None:
    value, half = rms_of_pieces(np.array([8.0]), np.array([2.0]))
    assert value == 2.0
    assert np.isnan(half)
    assert rms_of_pieces(np.zeros(3), np.ones(3)) == (0.0, 0.0)


def test_independent_revolutions_are_not_said_to_correlate() -> None:
    rng = np.random.default_rng(0)
    said = []
    for _ in range(50):
        revolutions = rng.standard_normal((28, 30))
        said.append(neighbour_correlation(list((revolutions - revolutions.mean(axis=0)).reshape(4, 7, 30))))
    assert np.mean(np.array(said) > 0) < 0.1


def test_correlated_revolutions_widen_the_interval() -> None:
    rng = np.random.default_rng(1)
    series = []
    for _ in range(4):
        x = np.empty((12, 30))
        x[0] = rng.standard_normal(30)
        for i in range(1, 12):
            x[i] = 0.6 * x[i - 1] + 0.8 * rng.standard_normal(30)
        series.append(x - x.mean(axis=0))
    rho = neighbour_correlation(series)
    assert 0.3 < rho < 0.7
    assert inflation(rho) > 1.8


def test_an_amplitude_interval_covers_near_zero_and_far_from_it() -> None:
    rng = np.random.default_rng(2)
    for true in (0.0, 0.5, 1.0, 2.0, 3.0, 6.0, 30.0):
        parts = rng.standard_normal((4000, 2)) + np.array([true, 0.0])
        covered = [lo <= true <= hi for _, lo, hi in (amplitude_interval(c, 1.0, 1.96) for c in np.hypot(*parts.T))]
        assert 0.93 < np.mean(covered) <= 1.0, f"amplitude {true}"


def test_noise_alone_is_mostly_called_not_resolved() -> None:
    rng = np.random.default_rng(3)
    low = [amplitude_interval(c, 1.0, 1.96)[1] for c in np.hypot(*rng.standard_normal((2, 4000)))]
    assert np.mean(np.array(low) > 0) < 0.06


@pytest.mark.parametrize(
    ("interval", "verdict"),
    [
        ((58.0, 59.9), Verdict.PASS),
        ((58.0, 60.1), Verdict.INCONCLUSIVE),
        ((60.1, 62.0), Verdict.FAIL),
        ((np.nan, np.nan), Verdict.INCONCLUSIVE),
    ],
)
def test_the_interval_is_its_own_guard_band(interval: tuple[float, float], verdict: Verdict) -> None:
    assert against_limit(interval, None, 60.0) is verdict
