"""An effect has one size in all runs; what only looks like it has another in each."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.judge import unsteadiness

RNG = np.random.default_rng(2)
KEYS = [(i, "M") for i in range(6)]


def solved(true: dict[Any, Any], noise: float) -> float:
    """Unsteadiness of an effect of fitted size 1 whose true size in each block is `true`."""
    f = {k: RNG.standard_normal(4000) for k in KEYS}
    e = {k: (true[k] - 1.0) * f[k] + noise * RNG.standard_normal(4000) for k in KEYS}
    left = {"with": e, "without": {k: e[k] + f[k] for k in KEYS}}
    design: Any = SimpleNamespace(
        y=dict.fromkeys(KEYS),
        residual=lambda key, which: left[which][key],
        eq=SimpleNamespace(noise=SimpleNamespace(kappa={"M": 1.0})),
    )
    whole: Any = SimpleNamespace(x="with")
    rest: Any = SimpleNamespace(x="without")
    return unsteadiness(whole, rest, design, dict.fromkeys(KEYS, 1.0))[0]


def test_the_same_size_everywhere_is_steady_whatever_the_noise() -> None:
    assert solved(dict.fromkeys(KEYS, 1.0), 0.1) < 0.01
    assert solved(dict.fromkeys(KEYS, 1.0), 1.0) < 0.02


def test_a_compromise_between_runs_is_told_by_its_spread() -> None:
    halves = {k: 1.5 if i % 2 else 0.5 for i, k in enumerate(KEYS)}
    assert solved(halves, 0.3) == pytest.approx(0.5, abs=0.02)
