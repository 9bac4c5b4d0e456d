"""Zeros of runs that go with the speed are told from those that wander, drift, or go with the way."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.rest import zeros_by_speed as module
from rig.analysis.tracing.rest.zeros_by_speed import ZerosBySpeed, zeros_by_speed
from rig.model.effect import MEASURED

SPEEDS = np.tile([12.5, 1.0, 6.0, 21.0, 31.0, 42.0, -6.0, -21.0, -42.0, 42.0], 3)  # rad/s
TIMES = 60.0 * np.arange(SPEEDS.size)  # s
WANDER, SIZE, SOFT = 1e-6, 1.2e-5, 1.33e-4  # rad, rad, rad/(N·m)
THROWN = SIZE * (SPEEDS / 42.0) ** 2


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: Sequence[float], speeds: np.ndarray = SPEEDS, torque: float = 0.0
) -> ZerosBySpeed | None:
    """Of runs with those zeros [rad], every third unseen; `torque` [N·m per rad] is what the load's balance shows."""
    runs = [
        SimpleNamespace(
            locked=False,
            has=MEASURED,
            mean_torque=0.5 * np.sign(v),
            turning=abs(v),
            pieces=[SimpleNamespace(t=np.array([t, t + 20.0]), omega_m=np.full(2, v))],
        )
        for t, v in zip(TIMES, speeds, strict=True)
    ]
    rows = {(i, c) for i in range(speeds.size) for c in "AL"}
    eq = SimpleNamespace(runs=runs, rows=rows)
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), value=lambda name: {"compliance": SOFT}[name])
    known = {"A": zeros, "L": torque * np.asarray(zeros)}
    for where in (module, offsets):
        monkeypatch.setattr(where, "offset", lambda _, run, channel: known[channel][run])
    unseen = range(1, speeds.size, 3)
    return zeros_by_speed(s, [i for i in range(speeds.size) if i not in unseen], unseen)


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
