"""Zeros of runs that are one way forth and the other way back above a speed are told from those that come late."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.residual import zeros_by_way as module
from rig.analysis.tracing.residual.zeros_by_way import ZerosByWay, zeros_by_way
from rig.core.units import RPM
from tests.analysis.tracing.zeros import SOFT, solution_of

SPEEDS = np.tile(RPM * np.array([120.0, 0.0, 60.0, -60.0, 240.0, -240.0, 300.0, -300.0, 420.0, -420.0]), 3)  # rad/s
WANDER, SIZE = 1e-6, 2.6e-5  # rad
STEP = SIZE * np.sign(SPEEDS) * (np.abs(SPEEDS) > 210 * RPM)


def found(
    monkeypatch: pytest.MonkeyPatch, zeros: np.ndarray, speeds: np.ndarray = SPEEDS, torque: float = 0.0
) -> ZerosByWay | None:
    """Of runs with those zeros [rad], every third unseen; `torque` [N·m per rad] is what the load's balance shows."""
    return zeros_by_way(*solution_of(monkeypatch, module, zeros, speeds, torque))


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
