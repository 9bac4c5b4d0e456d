"""A line in the load's balance: a torque that is there winds the gear up, a pick-up in a sensor's reading does not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import shaken_load as module
from rig.analysis.tracing.floor.interference import Interference
from rig.analysis.tracing.floor.shaken import Shaken
from rig.analysis.tracing.floor.shaken_load import shaken_load

HZ, TORQUE, K, J_L = 12.7, 0.1, 8000.0, 0.8  # Hz, N·m, N·m/rad, kg·m²
NOISE = 4e-6  # rad
T, SEEN = np.arange(0.0, 20.0, 0.008), np.arange(0.0, 20.0, 0.008)[3::2]  # rows of L, fewer of A
SIGMA = 17.0  # Hz, of the low-pass


def found(
    monkeypatch: pytest.MonkeyPatch, missed: float, *, channel: str = "L", runs: int = 8, reads: bool = True
) -> Shaken | None:
    """Of runs shaken in their own phase by a torque that swells and fades; the wind-up misses `missed` times what it
    misses of a pick-up in the torque sensor."""
    rng = np.random.default_rng(1)
    monkeypatch.setattr(module, "clock", lambda eq, key: T if key[1] == "L" else SEEN)
    passed = np.exp(-0.5 * (HZ / SIGMA) ** 2)
    columns, left = {}, {}
    for i in range(runs):
        swells, phase = 1.0 + 0.3 * np.sin(0.7 * T + i), rng.uniform(0, 6)
        wave = passed * TORQUE * swells * np.sin(2 * np.pi * HZ * T + phase)
        columns[i, "L"] = wave[:, None]
        left[i, "A"] = -missed * np.interp(SEEN, T, wave) / K + NOISE * rng.standard_normal(SEEN.size)
        left[i, "L"] = wave
    gear = SimpleNamespace(K=K, J_l=J_L)
    made = [
        SimpleNamespace(
            locked=False,
            knows={"tau_l"} if reads else set(),
            smoother=SimpleNamespace(sigma_hz=SIGMA),
            gear=gear,
        )
        for _ in range(runs)
    ]
    s: Any = SimpleNamespace(
        keys=tuple(left),
        design=SimpleNamespace(eq=SimpleNamespace(runs=made)),
        residual=left.__getitem__,
        value=lambda name: {"compliance": 1 / K}[name],
    )
    return shaken_load(s, Interference(channel, HZ, 1.01, 0.4, columns))


def test_a_torque_that_winds_the_gear_up_is_told_with_frequency_and_size(monkeypatch: pytest.MonkeyPatch) -> None:
    told = found(monkeypatch, 0.0)
    assert told is not None
    frequency, torque = told.parameters()
    assert frequency.ci95[0] <= HZ <= frequency.ci95[1]
    assert torque.value == pytest.approx(TORQUE, rel=0.05)
    assert "no pick-up of a sensor" in told.said


@pytest.mark.parametrize("missed", [1.0, 0.8, -0.5, (K / J_L) / (2 * np.pi * HZ) ** 2])
def test_what_the_wind_up_misses_is_in_a_reading(monkeypatch: pytest.MonkeyPatch, missed: float) -> None:
    """Of the torque sensor; or of the load encoder, which seems to accelerate the load by it."""
    assert found(monkeypatch, missed) is None


def test_a_line_louder_elsewhere_or_seen_in_two_runs_or_without_a_torque_sensor_is_none_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert found(monkeypatch, 0.0, channel="A") is None
    assert found(monkeypatch, 0.0, runs=2) is None
    assert found(monkeypatch, 0.0, reads=False) is None
