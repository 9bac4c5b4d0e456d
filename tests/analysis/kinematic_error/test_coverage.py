"""The 95 % intervals are 95 % intervals: many runs, one truth, none of the noise that the analysis knows of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from rig.analysis import analyse
from tests.analysis.synthetic import ARCSEC, PROFILE, slow_run

COEFFICIENTS = np.concatenate((PROFILE.a, PROFILE.b)) * ARCSEC
LARGE = np.abs(COEFFICIENTS) > 1.0


def inside(seed: int, **conditions: Any) -> tuple[np.ndarray, bool]:
    """Which coefficients, and whether the peak to peak, lie within their 95 % intervals of the truth."""
    result = analyse(slow_run(seed, **conditions))
    rows = result.tables["coefficients"]
    low = np.array([r["a_lo"] for r in rows] + [r["b_lo"] for r in rows], float)
    high = np.array([r["a_hi"] for r in rows] + [r["b_hi"] for r in rows], float)
    peak = next(e for e in result.estimates if e.name == "kinematic_error_peak_to_peak")
    truth = PROFILE.peak_to_peak() * ARCSEC
    return (low <= COEFFICIENTS) & (high >= COEFFICIENTS), peak.ci95[0] <= truth <= peak.ci95[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("conditions", "seeds"),
    [
        pytest.param({}, 16, id="as on the rig"),
        pytest.param(
            {"rate": 250.0, "counts_m": 65_536, "counts_l": 1_296_000}, 16, id="4 ms rows", marks=pytest.mark.long
        ),
        pytest.param({"cycles": 1}, 24, id="one cycle, six revolutions forward", marks=pytest.mark.long),
        pytest.param({"trend_arcsec": 60.0}, 24, id="eccentric output", marks=pytest.mark.long),
        pytest.param({"wander_s": 3.0, "wander_arcsec": 0.6}, 24, id="slow friction", marks=pytest.mark.long),
    ],
)
def test_intervals_cover_the_truth_as_often_as_they_say(conditions: Mapping[str, Any], seeds: int) -> None:
    """With 16 × 10 coefficients the share has σ = 0.017: the bounds are three of them on either side of 0.95."""
    covered = [inside(seed, **conditions) for seed in range(seeds)]
    share = np.mean([c[LARGE] for c, _ in covered])
    assert 0.90 <= share <= 0.995
    assert np.mean([p for _, p in covered]) >= 0.8


@pytest.mark.slow
@pytest.mark.long
def test_over_two_hundred_runs_every_coefficient_above_one_arcsec_is_covered_in_90_to_99_percent() -> None:
    covered = np.mean([inside(seed)[0] for seed in range(200)], axis=0)[LARGE]
    assert np.all((covered >= 0.90) & (covered <= 0.995)), np.round(covered, 3)
    assert 0.93 <= covered.mean() <= 0.975
