"""A delay that comes round by the clock: told from a vibration, an order and a drift by what goes with the speed."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import own_beats as module
from rig.analysis.tracing.floor.own_beats import BeatingDelay, own_beats
from rig.core.units import TURN
from rig.model.effect import Array

T = 0.008 * np.arange(1200)
SPEEDS = (0.25, 0.42, 0.63, 0.84, -0.25, -0.84)  # rad/s of the output
BEAT, MOST, NOISE = 2.7, 4e-4, 6e-6  # s, s, rad


def rig(monkeypatch: pytest.MonkeyPatch, speeds: tuple[float, ...]) -> Any:
    """Runs at those speeds, whose columns of the delay stand in A alone."""
    monkeypatch.setattr(module, "clock", lambda eq, key: T + 31.0 * key[0])
    monkeypatch.setattr(module, "at_rows", lambda eq, key, name: np.full(T.size, speeds[key[0]]))

    def term(run: int, one: Any) -> dict[str, Array]:
        signals: Any = SimpleNamespace(omega_l=np.full(T.size, speeds[run]), t=T + 31.0 * run)
        return {"A": -next(iter(one.effect.columns(signals, one.shape).values()))}

    return SimpleNamespace(runs=[SimpleNamespace(locked=False, has={"t"}) for _ in speeds], term=term)


def left(made: Callable[[float, Array], Array], speeds: tuple[float, ...] = SPEEDS) -> dict[tuple[int, str], Array]:
    rng = np.random.default_rng(8)
    return {(i, "A"): made(w, T + 31.0 * i) + NOISE * rng.standard_normal(T.size) for i, w in enumerate(speeds)}


def late(w: float, t: Array) -> Array:
    return w * MOST * np.mod(t / BEAT, 1.0)


def test_a_delay_between_two_clocks_is_found_with_its_period_and_swing(monkeypatch: pytest.MonkeyPatch) -> None:
    e = left(late)
    found = own_beats(rig(monkeypatch, SPEEDS), e, range(6), range(6))
    assert found is not None
    assert found.frequency == pytest.approx(1 / BEAT, rel=2e-3)
    words = {p.name: p for p in found.parameters()}
    assert words["scatter_theta_l"].value == pytest.approx(MOST / np.sqrt(12), rel=0.03)
    assert "2.7 s" in found.sentence()
    for key, columns in found.columns.items():
        z = np.column_stack([columns, np.ones(T.size)])
        rest = e[key] - z @ np.linalg.lstsq(z, e[key], rcond=None)[0]
        assert np.std(rest) < 2 * NOISE  # but for the row or two at which it falls back


@pytest.mark.parametrize(
    "made",
    [
        lambda w, t: np.zeros(T.size),
        lambda w, t: 5e-5 * np.sin(TURN * t / BEAT),  # a vibration: as large at any speed
        lambda w, t: 1e-4 * w * np.sin(7.0 * w * t),  # an order of a shaft
        lambda w, t: 1e-4 * w * (t - t[0]) / 10.0,  # a drift
    ],
)
def test_what_has_no_clock_or_does_not_go_with_the_speed_is_no_delay(
    monkeypatch: pytest.MonkeyPatch, made: Callable[[float, Array], Array]
) -> None:
    assert own_beats(rig(monkeypatch, SPEEDS), left(made), range(6), range(6)) is None


def test_at_one_speed_nobody_can_tell(monkeypatch: pytest.MonkeyPatch) -> None:
    speeds = (0.84, -0.84, 0.84)
    assert own_beats(rig(monkeypatch, speeds), left(late, speeds), range(3), range(3)) is None


def test_its_columns_are_delays_of_the_load_angle() -> None:
    signals: Any = SimpleNamespace(omega_l=np.full(T.size, 0.5), t=T)
    (columns,) = BeatingDelay().columns(signals, (1 / BEAT, 0.0)).values()
    assert columns[:, 0] == pytest.approx(-0.5)
    assert columns[:, 1] == pytest.approx(-0.5 * (np.mod(T / BEAT, 1.0) - 0.5))
