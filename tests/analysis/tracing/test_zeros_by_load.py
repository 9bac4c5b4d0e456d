"""Zeros of runs that go with what hung on the output are told from those that wander, drift, or go with the speed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from rig.analysis.tracing.residual import zeros_along as module
from rig.analysis.tracing.residual.zeros_by_load import ZerosByLoad, zeros_by_load
from tests.analysis.tracing.zeros import SOFT, solution_of

WEIGHTS = np.tile([0.0, -2.5, -5.0, -10.0, -20.0, -40.0, 0.0, 0.0, -10.0, -40.0], 3)  # N·m
SPEEDS = np.tile([12.5, 1.0, 1.0, 1.0, 1.0, 1.0, -6.0, 42.0, 1.0, 1.0], 3)  # rad/s
TIMES = 60.0 * np.arange(WEIGHTS.size)  # s
WANDER, SIZE = 1e-6, 2e-5  # rad
ASIDE = SIZE * np.sqrt(np.abs(WEIGHTS) / 40.0)


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: Sequence[float], weights: np.ndarray = WEIGHTS, torque: float = 0.0
) -> ZerosByLoad | None:
    """Of runs with those zeros [rad], every third unseen; `torque` [N·m per rad] is what the load's balance shows."""
    return zeros_by_load(*solution_of(monkeypatch, module, zeros, SPEEDS, torque, weights))


def wander(rng: np.random.Generator) -> np.ndarray:
    return WANDER * rng.standard_normal(WEIGHTS.size)


def test_zeros_that_go_with_the_root_of_the_weight_are_told_with_their_size(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    told = found(monkeypatch, wander(rng) + ASIDE)
    assert told
    assert told.size == pytest.approx(SIZE, rel=0.15)
    assert "go with what hangs on the output, by" in told.sentence()


def test_other_zeros_are_another_thing(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert not any(found(monkeypatch, 20.0 * wander(rng)) for _ in range(50))
    assert found(monkeypatch, wander(rng) + 1e-8 * TIMES) is None
    assert found(monkeypatch, wander(rng) + SIZE * SPEEDS / 42.0) is None
    assert found(monkeypatch, wander(rng) - ASIDE, torque=-1 / SOFT) is None  # the torque sensor's


def test_of_a_few_weights_any_curve_goes_through_any_zeros(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    few = np.where(WEIGHTS < -5.0, -40.0, 0.0)
    assert found(monkeypatch, wander(rng) + SIZE * (few < 0.0), few) is None
