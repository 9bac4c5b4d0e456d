"""A drag that is more one way, told by the zeros of runs that turn one way each."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.residual import uneven_drag as module
from rig.analysis.tracing.residual.uneven_drag import UnevenDrag, uneven_drag
from rig.model.effect import Array

SPEEDS = np.repeat([6.3, -6.3, 12.6, 21.0, -21.0, 31.0, 42.0, -42.0], 3)  # rad/s, each taken three times
FLOOR, WANDER, DRAG = 1.5e-3, 5e-4, 18e-3  # N·m, the last at the fastest
COMPLIANCE = 1.3e-4  # rad/N·m


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: Array, speeds: Array = SPEEDS, channel: str = "M", sensor: float = 0.0
) -> UnevenDrag | None:
    """Of runs with those zeros [N·m], every third of them unseen; θ̃ is off by what `sensor` of them would wind up."""
    runs = [
        SimpleNamespace(locked=False, start=80.0 * i, turning=abs(w), pieces=[SimpleNamespace(omega_m=np.full(5, w))])
        for i, w in enumerate(speeds)
    ]
    rows = {(i, c) for i in range(len(runs)) for c in ("A", channel)}
    eq = SimpleNamespace(runs=runs, rows=rows)
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), value=lambda name: COMPLIANCE)
    for where in (module, offsets):
        monkeypatch.setattr(
            where, "zero", lambda _, run, channel: -sensor * COMPLIANCE * zeros[run] if channel == "A" else zeros[run]
        )
    unseen = range(2, len(runs), 3)
    return uneven_drag(s, [i for i in range(len(runs)) if i not in unseen], unseen, FLOOR, channel)


def wander(rng: np.random.Generator) -> Array:
    return WANDER * rng.standard_normal(SPEEDS.size) + 3e-3


@pytest.mark.parametrize("power", [0.5, 1.0, 2.0])
def test_zeros_that_grow_with_the_speed_both_ways_are_a_drag_that_is_more_one_way(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, power: float
) -> None:
    more = found(monkeypatch, wander(rng) - DRAG * (np.abs(SPEEDS) / 42.0) ** power)
    assert more
    assert more.size == pytest.approx(-2 * DRAG, abs=2 * more.half)
    assert more.half < 0.2 * abs(more.size)
    assert "more backward than the other way at 401 rpm" in more.sentence()


def test_what_friction_has_wrong_turns_with_the_way_and_is_no_uneven_drag(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    odd = 5e-3 * np.sign(SPEEDS) + 4e-4 * SPEEDS
    drift = 1e-5 * 80.0 * np.arange(SPEEDS.size)
    for zeros in (0.0, odd, drift, odd + drift):
        assert not any(found(monkeypatch, zeros + wander(rng)) for _ in range(20))


def test_where_the_motor_hardly_turns_the_other_way_it_is_any_drag(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert found(monkeypatch, wander(rng) + DRAG * np.abs(SPEEDS) / 42.0, np.abs(SPEEDS)) is None


def test_one_that_nobody_would_feel_is_not_told(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    assert found(monkeypatch, 0.1 * wander(rng) + 0.5 * FLOOR * np.abs(SPEEDS) / 42.0) is None


@pytest.mark.parametrize(("sensor", "told"), [(0.0, True), (0.1, True), (1.0, False)])
def test_of_the_load_it_is_told_unless_the_torque_sensor_reads_it_alone(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, sensor: float, told: bool
) -> None:
    more = found(monkeypatch, wander(rng) - DRAG * np.abs(SPEEDS) / 42.0, channel="L", sensor=sensor)
    assert (more is not None) is told
    if more:
        assert more.sentence().startswith("The load is dragged by 0.03")
