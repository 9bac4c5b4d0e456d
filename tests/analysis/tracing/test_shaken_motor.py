"""A line in the motor's balance: a torque that shakes the motor moves it, a pick-up in its reading does not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.floor.interference import Interference
from rig.analysis.tracing.floor.shaken import Shaken
from rig.analysis.tracing.floor.shaken_motor import shaken_motor

HZ, TORQUE, NOISE, INERTIA = 8.7, 1.4e-3, 1e-3, 4e-5  # Hz, N·m, N·m, kg·m²
T = np.arange(0.0, 20.0, 0.01)
SIGMA = 17.0  # Hz, of the low-pass


def found(moves: float, *, channel: str = "M", apart: float = 1.001, runs: int = 8) -> Shaken | None:
    """Of runs whose motor's inertia takes `moves` of the wave, each with its own phase."""
    rng = np.random.default_rng(1)
    columns, rows = {}, {}
    passed = np.exp(-0.5 * (HZ / SIGMA) ** 2)
    for i in range(runs):
        wave = passed * TORQUE * np.sin(2 * np.pi * HZ * T + rng.uniform(0, 6))
        columns[i, "M"] = wave[:, None]
        inertia = moves * wave + NOISE * rng.standard_normal(T.size)
        rows[i, "M"] = SimpleNamespace(z=inertia[:, None] / INERTIA, at=(INDEX["J_m"],))
    made = [SimpleNamespace(locked=False, smoother=SimpleNamespace(sigma_hz=SIGMA)) for _ in range(runs)]
    s: Any = SimpleNamespace(
        keys=tuple(columns),
        design=SimpleNamespace(eq=SimpleNamespace(runs=made, rows=rows)),
        value=lambda name: {"J_m": INERTIA}[name],
    )
    return shaken_motor(s, Interference(channel, HZ, apart, 0.8, columns))


@pytest.mark.parametrize("moves", [-1.0, -0.4, 0.1])  # an open loop, a soft one, one that answers by more
def test_a_torque_that_moves_the_motor_is_told_with_frequency_and_size(moves: float) -> None:
    told = found(moves)
    assert told is not None
    frequency, torque = told.parameters()
    assert frequency.ci95[0] <= HZ <= frequency.ci95[1]
    assert torque.value == pytest.approx(TORQUE, rel=0.02)
    assert torque.unit == "N·m"


def test_what_the_motor_does_not_follow_is_a_pick_up() -> None:
    assert found(0.0) is None


def test_a_line_that_wanders_or_is_louder_elsewhere_or_seen_in_two_runs_is_none_of_it() -> None:
    assert found(-1.0, apart=1.1) is None
    assert found(-1.0, channel="A") is None
    assert found(-1.0, runs=2) is None
