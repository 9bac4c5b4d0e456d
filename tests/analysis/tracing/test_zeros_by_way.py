"""Zeros of runs that are one way forth and the other way back above a speed are told from those that come late."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import offsets
from rig.analysis.tracing.rest import zeros_by_way as module
from rig.analysis.tracing.rest.zeros_by_way import ZerosByWay, zeros_by_way
from rig.core.units import RPM
from rig.model.effect import MEASURED

SPEEDS = np.tile(RPM * np.array([120.0, 0.0, 60.0, -60.0, 240.0, -240.0, 300.0, -300.0, 420.0, -420.0]), 3)  # rad/s
WANDER, SIZE, SOFT = 1e-6, 2.6e-5, 1.33e-4  # rad, rad, rad/(N·m)
STEP = SIZE * np.sign(SPEEDS) * (np.abs(SPEEDS) > 210 * RPM)


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: np.ndarray, speeds: np.ndarray = SPEEDS, torque: float = 0.0
) -> ZerosByWay | None:
    """Of runs with those zeros [rad], every third unseen; `torque` [N·m per rad] is what the load's balance shows."""
    times = 60.0 * np.arange(speeds.size)
    runs = [
        SimpleNamespace(
            locked=False,
            has=MEASURED,
            mean_torque=0.5 * np.sign(v),
            pieces=[SimpleNamespace(t=np.array([t, t + 20.0]), omega_m=np.full(2, v))],
        )
        for t, v in zip(times, speeds, strict=True)
    ]
    eq = SimpleNamespace(runs=runs, rows={(i, c) for i in range(speeds.size) for c in "AL"})
    s: Any = SimpleNamespace(design=SimpleNamespace(eq=eq), value=lambda name: {"compliance": SOFT}[name])
    known = {"A": zeros, "L": torque * zeros}
    for where in (module, offsets):
        monkeypatch.setattr(where, "offset", lambda _, run, channel: known[channel][run])
    unseen = range(1, speeds.size, 3)
    return zeros_by_way(s, [i for i in range(speeds.size) if i not in unseen], unseen)


def wander(rng: np.random.Generator) -> np.ndarray:
    return WANDER * rng.standard_normal(SPEEDS.size)


def test_a_counter_that_cuts_off_above_a_speed_is_told_with_both(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    told = found(monkeypatch, STEP + wander(rng))
    assert told
    assert told.size == pytest.approx(2 * SIZE, rel=0.1)
    assert 120 < told.above / RPM < 240
    assert "10.7 arcsec apart forth and back in runs above 180 rpm" in ZerosByWay(2 * SIZE, 180 * RPM, 1.0).sentence()


@pytest.mark.parametrize(
    "zeros",
    [0.0 * SPEEDS, 4e-7 * SPEEDS, 1e-8 * SPEEDS**2, SIZE * (np.arange(SPEEDS.size) > 14)],
    ids=["wander", "come late", "are thrown", "jumped once"],
)
def test_what_else_shifts_zeros_is_no_such_thing(
    zeros: np.ndarray, monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert found(monkeypatch, zeros + wander(rng)) is None


def test_what_the_torque_sensor_shows_as_well_is_its_own(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    assert found(monkeypatch, STEP + wander(rng), torque=-1 / SOFT) is None


def test_one_run_each_way_is_too_few(monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator) -> None:
    few = np.where(np.abs(SPEEDS) > 210 * RPM, 0.0, SPEEDS)
    few[[4, 5]] = SPEEDS[[4, 5]]
    zeros = SIZE * np.sign(few) * (np.abs(few) > 210 * RPM)
    assert found(monkeypatch, zeros + wander(rng), few) is None
