"""Zeros of runs that go with the speed are told from those that wander, drift, or go with the way."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from rig.analysis.tracing.residual import zeros_along as module
from rig.analysis.tracing.residual.zeros_by_speed import ZerosBySpeed, zeros_by_speed
from tests.analysis.tracing.zeros import SOFT, solution_of

SPEEDS = np.tile([12.5, 1.0, 6.0, 21.0, 31.0, 42.0, -6.0, -21.0, -42.0, 42.0], 3)  # rad/s
TIMES = 60.0 * np.arange(SPEEDS.size)  # s
WANDER, SIZE = 1e-6, 1.2e-5  # rad
THROWN = SIZE * (SPEEDS / 42.0) ** 2


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: Sequence[float], speeds: np.ndarray = SPEEDS, torque: float = 0.0
) -> ZerosBySpeed | None:
    """Of runs with those zeros [rad], every third unseen; `torque` [N·m per rad] is what the load's balance shows."""
    return zeros_by_speed(*solution_of(monkeypatch, module, zeros, speeds, torque))


def wander(rng: np.random.Generator) -> np.ndarray:
    return WANDER * rng.standard_normal(SPEEDS.size)


def test_zeros_that_go_with_the_square_of_the_speed_are_told_with_their_size(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    told = found(monkeypatch, wander(rng) + THROWN)
    assert told
    assert told.size == pytest.approx(SIZE, rel=0.2)
    assert told.torque == 0.0
    assert "zeros of the angles go with the speed" in told.sentence()


def test_they_are_the_torque_sensors_where_the_loads_balance_shows_them_too(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    told = found(monkeypatch, wander(rng) - THROWN, torque=-1 / SOFT)
    assert told
    assert told.torque == pytest.approx(SIZE / SOFT, rel=0.2)
    assert "N·m" in told.sentence()


def test_other_zeros_are_another_thing(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert not any(found(monkeypatch, 20.0 * wander(rng)) for _ in range(50))
    assert found(monkeypatch, wander(rng) + 1e-8 * TIMES) is None
    assert found(monkeypatch, wander(rng) + SIZE * SPEEDS / 42.0) is None  # a reading that comes late
    rising = np.sort(np.abs(SPEEDS))  # each faster than the one before: it may be the time as well
    assert found(monkeypatch, wander(rng) + SIZE * TIMES / TIMES[-1], rising) is None
