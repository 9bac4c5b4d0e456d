"""What a vibration has beside its lines in one run is that run's own, and no ripple of the motor is taken for it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor import sidebands as module
from rig.analysis.tracing.floor.sidebands import sidebands

T = 0.01 * np.arange(40_000)  # 400 s
CARRIER = 21.1  # Hz


def found_in(monkeypatch: pytest.MonkeyPatch, e: np.ndarray, turning: float) -> list[float]:
    """Hz of the lines found in the residual `e` (n,) of one run whose motor turns so many times a second."""
    asked: list[float] = []

    def columns(eq: Any, run: int, hz: float) -> dict[str, np.ndarray]:
        asked.append(hz)
        return {"L": np.stack([np.cos(2 * np.pi * hz * T), np.sin(2 * np.pi * hz * T)], 1)}

    monkeypatch.setattr(module, "clock", lambda eq, key: T)
    monkeypatch.setattr(module, "_columns", columns)
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(turning=2 * np.pi * turning)])
    made = sidebands(eq, {(0, "L"): e}, [CARRIER])
    found = sorted(dict.fromkeys(asked[1:]))  # the first is the carrier's own
    assert (made[0, "L"].shape[1] if made else 0) == 2 * len(found)
    return found


def test_a_run_has_the_lines_of_its_own_swell_and_all_of_it_is_taken(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    swell = 1.0 + 0.8 * np.cos(2 * np.pi * 0.0731 * T + 0.4)
    e = swell * np.cos(2 * np.pi * CARRIER * T) + 0.3 * rng.standard_normal(T.size)
    found = found_in(monkeypatch, e, 0.2)
    assert found == pytest.approx([CARRIER - 0.0731, CARRIER + 0.0731], abs=2e-4)
    z = np.hstack([np.stack([np.cos(2 * np.pi * f * T), np.sin(2 * np.pi * f * T)], 1) for f in [CARRIER, *found]])
    assert np.std(e - z @ np.linalg.lstsq(z, e, rcond=None)[0]) == pytest.approx(0.3, rel=0.02)


def test_noise_has_none_and_an_order_of_the_motor_is_left_where_it_is(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator
) -> None:
    noise = 0.3 * rng.standard_normal(T.size)
    carrier = np.cos(2 * np.pi * CARRIER * T)
    assert found_in(monkeypatch, carrier + noise, 5.3) == []
    order = carrier + 0.2 * np.cos(2 * np.pi * 4 * 5.3 * T) + noise
    assert found_in(monkeypatch, order, 5.3) == []
    assert found_in(monkeypatch, order, 5.0) == pytest.approx([21.2], abs=1e-3), "of a motor at another speed"
