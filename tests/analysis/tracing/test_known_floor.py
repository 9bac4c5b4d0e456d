"""How well a floor is known."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.floor.known import known
from rig.analysis.tracing.floor.repeats import Scatter

ROWS, RHO = 400, np.array([1.0])


def pair(rms: float, freedom: float) -> Scatter:
    return Scatter((0, 1), rms, ROWS, 0.0, RHO, freedom)


@pytest.mark.parametrize(("pairs", "wander"), [(3, 0.0), (15, 0.0), (12, 0.3)])
def test_intervals_cover(pairs: int, wander: float) -> None:
    """Pairs of forty independent parts each, whose noise `wander`s from pair to pair."""
    rng, inside = np.random.default_rng(pairs), 0
    for _ in range(1000):
        sizes = 2.0 * np.exp(wander * rng.standard_normal(pairs) - wander**2)
        found = [pair(size * np.sqrt(rng.chisquare(40) / 40), 40.0) for size in sizes]
        low, high = known(found)
        inside += low < 2.0 < high
    assert inside > 870


def test_an_interval_is_that_of_chi_squared() -> None:
    low, high = known([pair(1.0, 10.0)])
    assert low == pytest.approx(np.sqrt(10 / 20.483), rel=1e-3)  # tables of χ², 10 degrees of freedom
    assert high == pytest.approx(np.sqrt(10 / 3.247), rel=1e-3)


def test_pairs_that_differ_by_more_than_their_rows_widen_it() -> None:
    low, high = known([pair(rms, 1000.0) for rms in (0.7, 1.3, 0.8, 1.2)])
    alike = known([pair(1.0, 1000.0)] * 4)
    assert high - low > 5 * (alike[1] - alike[0])
    assert low < np.sqrt(np.mean(np.square([0.7, 1.3, 0.8, 1.2]))) < high
