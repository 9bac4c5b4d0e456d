"""A name that stands in the means of runs is borne out by those of unseen ones."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.selection import zeros_foretold as module
from rig.analysis.tracing.selection.score import HeldOutScore

ROWS, KEPT, SCATTER = 200, 0.9, 1e-6  # rows of a run, share of its mean that is its own, rad
MEANS = 1e-6 * np.array([0.4, 6.6, 8.8, 9.3, -7.8, 0.6, -7.0, 0.5])


def design(means: np.ndarray, kept: float = KEPT, locked: bool = False) -> Any:
    """Runs of which that is left in the mean, as far as it is not their own; rows differ besides."""
    swing = 2e-6 * np.sin(np.linspace(0, 40 * np.pi, ROWS, endpoint=False))
    y = {(i, "A"): swing + (1 - kept) * mean for i, mean in enumerate(means)}
    runs = [SimpleNamespace(locked=locked) for _ in means]
    eq = SimpleNamespace(runs=runs, share_of_mean=lambda key, n: kept)
    return SimpleNamespace(y=y, eq=eq, residual=lambda key, x: y[key])


def foretold(monkeypatch: pytest.MonkeyPatch, before: Any, after: Any) -> bool:
    monkeypatch.setattr(module, "unseen", lambda s, at: before)
    p: Any = SimpleNamespace(
        eq=SimpleNamespace(noise=SimpleNamespace(local={"A": SCATTER})), baseline=SimpleNamespace(x=()), held_out=None
    )
    score = HeldOutScore("nonlinear_stiffness", 0.84, 1.07, 1.07, 0.7, ((0, "A"), (0, "R")))
    selected: Any = SimpleNamespace(scores=[score], solution=SimpleNamespace(x=()), held=after)
    return module.are_foretold(p, selected)


def test_means_that_go_to_where_repeats_differ_are_foretold(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    chance = SCATTER * rng.standard_normal(MEANS.size)
    assert foretold(monkeypatch, design(MEANS + chance), design(chance))
    assert not foretold(monkeypatch, design(MEANS + chance), design(0.6 * MEANS + chance))
    assert not foretold(monkeypatch, design(chance), design(np.zeros(MEANS.size)))  # they were never apart


def test_of_few_runs_or_such_as_keep_all_of_a_mean_nothing_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    nothing = np.zeros(MEANS.size)
    assert not foretold(monkeypatch, design(MEANS[:5]), design(nothing[:5]))
    assert not foretold(monkeypatch, design(MEANS, kept=0.995), design(nothing, kept=0.995))
    assert not foretold(monkeypatch, design(MEANS, locked=True), design(nothing, locked=True))
