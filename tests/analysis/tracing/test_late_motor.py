"""A motor torque that is told a little before it acts is no missing effect."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from tests.analysis.tracing.spiked import RATIO, STIFFNESS, Columns, spiked

J_M, J_L = 1.466e-3, 0.781  # kg·m², of the open campaign, as its truth says
B_M, B_SP = 4.5e-3, 5.6  # N·m·s/rad
EARLY = 5e-4  # s
SWEPT = ("load_5nm_1", "load_5nm_2", "load_20nm_1", "load_20nm_2")
SOME = (*SWEPT, "slow_ke_1", "slow_ke_2", "load_40nm_1", "load_40nm_2", "speed_200rpm_1", "speed_200rpm_2",
        "speed_400rpm_1", "speed_minus200rpm_1")  # fmt: skip


def swept(early: float) -> Callable[[Columns, float], Columns]:
    """A torque of the motor swept from 18 to 28 Hz in the loaded runs, and how it swings motor and load."""

    def law(c: Columns, began: float) -> Columns:
        t = c["t"] - c["t"][0]
        if np.ptp(t) < 30.0 or np.ptp(c["theta_m"]) > 40.0:  # at speed, or the paper's slow runs
            return {}
        theta_l, theta_m, tau_l, _ = swing(t, float(np.ptp(t)))
        tau_m = swing(t + early, float(np.ptp(t)))[3]
        return {
            "theta_l": c["theta_l"] + theta_l,
            "theta_m": c["theta_m"] + theta_m,
            "tau_l": c["tau_l"] + tau_l,
            "tau_m": c["tau_m"] + tau_m,
        }

    return law


def swing(t: np.ndarray, over: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """θ_l, θ_m [rad], τ_l, τ_m [N·m], (n,) each, at `t` s of a sweep that takes `over` s: slow enough for each of its
    frequencies to be a steady one."""
    omega = 2 * np.pi * (18.0 + 10.0 * t / over)
    phase = np.exp(1j * 2 * np.pi * (18.0 * t + 5.0 * t**2 / over))
    torque = 1.2 * phase
    theta_l = -torque / (J_L * omega**2)
    theta_m = RATIO * (theta_l + torque / (STIFFNESS + 1j * B_SP * omega))
    motor = torque / RATIO + (1j * B_M * omega - J_M * omega**2) * theta_m
    return theta_l.real, theta_m.real, torque.real, motor.real


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("early", [0.0, EARLY])
def test_a_torque_that_is_told_before_it_acts_is_told_with_by_how_much(
    shared: Path, tmp_path: Path, early: float
) -> None:
    found = spiked(tmp_path, shared / "cases" / "open-1", swept(early), SOME)
    assert (found.verdict.status, found.verdict.effects) == (Status.NOTHING, ())
    told = [p for p in found.baseline if p.name == "lag_m"]
    assert any("before it acts" in said for said in found.cannot) is bool(early)
    assert [p.value for p in told] == ([pytest.approx(-early, rel=0.1)] if early else [])
