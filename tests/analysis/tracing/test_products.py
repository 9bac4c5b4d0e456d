"""Products of the baseline's columns made from sums over rows are those of the columns themselves."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Equations, Noise
from rig.analysis.tracing.fit.rows import Rows
from rig.analysis.tracing.residual.joined import _elsewhere

KEY = (0, "M")


def block(rng: np.random.Generator, own: int) -> Rows:
    """Two hundred rows of four columns, one of them a constant and one far from zero beside what it varies by."""
    z = np.stack([rng.standard_normal(200), np.ones(200), 1e5 + rng.standard_normal(200), rng.uniform(size=200)], 1)
    every = np.ones(200, dtype=bool)
    return Rows(3.0 + rng.standard_normal(200), z, (0, 1, 2, 3), every, np.zeros(200), rng.uniform(size=(200, own)))


@pytest.mark.parametrize("local", [1e-3, 0.02, np.inf])
@pytest.mark.parametrize("own", [0, 2])
def test_products_are_those_of_bare_columns(rng: np.random.Generator, local: float, own: int) -> None:
    r = block(rng, own)
    eq = Equations((), {KEY: r}, Noise({"M": 0.1}, {"M": 2.0}, {"M": local}))
    bare = eq.bare(KEY, r.z)
    gram, right = eq.products(KEY)
    np.testing.assert_allclose(gram, bare.T @ bare, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(right, bare.T @ eq.bare(KEY, r.y), rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(eq.baseline(KEY).whole(), bare, rtol=1e-12, atol=1e-9)


def test_what_other_blocks_know_is_the_sum_of_what_their_bare_columns_do(rng: np.random.Generator) -> None:
    keys = [(0, "M"), (1, "M")]
    rows = dict(zip(keys, (block(rng, 0), block(rng, 2)), strict=True))
    eq = Equations((), rows, Noise({"M": 0.1}, {"M": 2.0}, {"M": np.inf}))
    bare = [eq.bare(key, rows[key].z) for key in keys]
    known = _elsewhere(eq, keys)[:4, :4]
    np.testing.assert_allclose(known, sum(50.0 * z.T @ z for z in bare), rtol=1e-9, atol=1e-4)
