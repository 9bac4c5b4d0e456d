"""Zeros that follow a thermometer are told from those that wander, and from those that follow the time alone."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual import warm_zeros as module
from rig.analysis.tracing.residual.warm_zeros import WarmZeros, warm_zeros
from rig.core.units import ARCSEC
from rig.model.effect import MEASURED, Array

RUNS, EVERY = 30, 80.0  # s
TIMES = EVERY * np.arange(RUNS)
ROOM = 22.0 + 3.0 * np.sin(TIMES / 300.0)  # °C, a room that is aired
SLOPE, WANDER, SOFT = ARCSEC, 0.4 * ARCSEC, 1.33e-4  # rad/K, rad, rad/(N·m)


LARGEST = 20.0  # N·m


def found(
    monkeypatch: pytest.MonkeyPatch,
    zeros: Array,
    warmth: Array = ROOM,
    of_the_torque: Array | None = None,
    has: frozenset[str] = MEASURED,
) -> WarmZeros | None:
    """Of runs with those zeros [rad] and temperatures [°C], every third of them unseen."""
    runs = [
        SimpleNamespace(
            locked=False,
            has=has,
            mean_torque=0.5 * (-1) ** i,
            pieces=[
                SimpleNamespace(
                    t=np.array([t, t + 20.0]),
                    omega_m=np.full(2, speed),
                    temperature=np.full(2, warm),
                    torque=np.full(2, LARGEST),
                )
            ],
        )
        for i, (t, speed, warm) in enumerate(zip(TIMES, np.tile([10.0, 30.0, -20.0], 10), warmth, strict=True))
    ]
    rows = {(i, c) for i in range(RUNS) for c in ("A" if of_the_torque is None else "AL")}
    eq = SimpleNamespace(runs=runs, rows=rows)
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), value=lambda name: {"compliance": SOFT}[name])
    known = {"A": zeros, "L": of_the_torque}
    monkeypatch.setattr(module, "zero", lambda _, run, channel: known[channel][run])
    unseen = range(1, RUNS, 3)
    return warm_zeros(s, [i for i in range(RUNS) if i not in unseen], unseen)


def test_zeros_that_follow_the_temperature_are_told_with_their_slope(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    warm = found(monkeypatch, SLOPE * (ROOM - 22.0) + WANDER * rng.standard_normal(RUNS))
    assert warm
    assert warm.slope == pytest.approx(SLOPE, rel=0.15)
    assert warm.size == pytest.approx(6.0 * ARCSEC, rel=0.15)
    assert "arcsec a kelvin over 6.0 K" in warm.sentence()


def test_zeros_that_wander_and_zeros_that_follow_the_time_are_not(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert not any(found(monkeypatch, WANDER * rng.standard_normal(RUNS)) for _ in range(20))
    drift = 6.0 * ARCSEC * (1 - np.exp(-TIMES / 700.0)) + 0.2 * WANDER * rng.standard_normal(RUNS)
    assert found(monkeypatch, drift) is None
    assert found(monkeypatch, drift, warmth=20.0 + TIMES / 800.0) is None  # warmer all the time, but not as they go


def test_without_a_thermometer_or_at_one_temperature_nothing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    zeros = SLOPE * (ROOM - 22.0)
    assert found(monkeypatch, zeros, warmth=np.full(RUNS, np.nan)) is None
    assert found(monkeypatch, zeros, warmth=22.0 + (ROOM - 22.0) / 20.0) is None


@pytest.mark.parametrize(("slope", "told"), [(0.05, True), (0.005, False)])
def test_a_torque_sensor_whose_zero_follows_the_temperature_is_no_shift_of_the_angles(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, slope: float, told: bool
) -> None:
    """N·m/K: of 20 N·m a thirtieth of one is what every sensor does."""
    torque = slope * (ROOM - 22.0)  # N·m
    noise = 0.1 * SOFT * torque.std() * rng.standard_normal(RUNS)
    warm = found(monkeypatch, noise - SOFT * torque, of_the_torque=torque)
    assert (warm is not None) is told
    if warm:
        assert warm.torque == pytest.approx(slope, rel=0.1)
        assert "zero of the torque sensor follows the temperature, by 0.0" in warm.sentence()
    both = found(monkeypatch, noise - SOFT * torque + SLOPE * (ROOM - 22.0), of_the_torque=torque)
    assert both
    assert not both.torque


@pytest.mark.parametrize(("wander", "told", "unread"), [(0.1, True, True), (0.75, True, False), (2.0, False, False)])
def test_where_nobody_read_the_torque_the_temperature_must_foretell_more(
    monkeypatch: pytest.MonkeyPatch, wander: float, told: bool, unread: bool
) -> None:
    """`wander` in arcsec, of zeros that lie 2 apart, RMS."""
    zeros = SLOPE * (ROOM - 22.0) + wander * ARCSEC * np.random.default_rng(3).standard_normal(RUNS)
    assert (found(monkeypatch, zeros) is not None) is told
    assert (found(monkeypatch, zeros, has=frozenset({"t", "theta_m", "theta_l"})) is not None) is unread
    assert found(monkeypatch, zeros, has=frozenset({"t", "theta_m", "tau_l"})) is None
