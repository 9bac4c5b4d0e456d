"""The spring's law in the lock test: wind-up is the analytic inverse of the torque, and nothing else winds it up."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from sim.effects import Effects, Stiffness
from sim.parameters import TwinParameters
from sim.plant import Plant
from tests.sim.conftest import FRICTIONLESS, with_gear

TICK = 1e-3  # s
CUBIC = Stiffness(cubic=2.3e9)
PIECES = Stiffness(T1=4.0, T2=10.0, K2=9500.0, K3=11500.0)
GAP = Stiffness(gap_deg=0.004)


def by_cube(tau: float, K: float) -> float:
    """The real root of K·w + k3·w³ = τ      [Cardano]"""
    p, q = K / CUBIC.cubic, -tau / CUBIC.cubic
    root = math.sqrt(q * q / 4 + p**3 / 27)
    return float(np.cbrt(-q / 2 + root) + np.cbrt(-q / 2 - root))


def by_pieces(tau: float, K: float) -> float:
    size = min(abs(tau), 4.0) / K + min(max(abs(tau) - 4.0, 0.0), 6.0) / 9500.0 + max(abs(tau) - 10.0, 0.0) / 11500.0
    return math.copysign(size, tau)


def by_gap(tau: float, K: float) -> float:
    return math.copysign(abs(tau) / K + math.radians(0.004), tau)


LAWS = {"cubic": (CUBIC, by_cube), "pieces": (PIECES, by_pieces), "dead zone": (GAP, by_gap)}


def locked_at_rest(parameters: TwinParameters) -> tuple[np.ndarray, np.ndarray]:
    """Shaft torque and wind-up θ_m/N − θ̃_p − θ_l wherever friction holds the motor for a moment."""
    plant, rows = Plant(parameters), []
    plant.locked = True
    for k in range(12000):
        plant.advance(TICK, 0.8 * math.sin(2 * math.pi * k * TICK / 6.0))
        x = plant.truth()
        if x.omega_m == 0.0:
            error = float(parameters.gear.kinematic_error.value(np.array(x.theta_m)))
            rows.append((x.tau_l, x.theta_m / parameters.gear.ratio - error - x.theta_l))
    tau, wind_up = np.array(rows).T
    return tau, wind_up


@pytest.mark.slow
@pytest.mark.parametrize("name", LAWS)
def test_wind_up_in_the_lock_test_is_the_inverse_of_the_law(calm: TwinParameters, name: str) -> None:
    law, inverse = LAWS[name]
    tau, wind_up = locked_at_rest(dataclasses.replace(calm, effects=Effects(stiffness=law)))
    loaded = np.abs(tau) > 1e-9  # inside the dead zone any wind-up will do
    assert np.ptp(tau) > 20.0
    expected = [inverse(t, calm.gear.K) for t in tau[loaded]]
    np.testing.assert_allclose(wind_up[loaded], expected, atol=1e-15, rtol=1e-9)


def frequency(parameters: TwinParameters, preload: float) -> float:
    """Hz, of small swings of the load about a preload, the motor held by its friction."""
    held = with_gear(parameters, B_sp=0.0, B_l=0.0, B_ml=0.0, F_cl=0.0, tau_s=9.0, tau_c=9.0)
    plant, torque = Plant(held), []
    plant.place(0.0)
    plant.tau_ext = preload
    damped = Plant(with_gear(held, B_l=20.0))
    damped.place(0.0)
    damped.tau_ext = preload
    for _ in range(4000):
        damped.advance(TICK, 0.0)
    plant.place(0.0, twist=damped.truth().phi + 1e-6)
    for _ in range(2000):
        plant.advance(TICK, 0.0)
        torque.append(plant.truth().tau_l)
    swing = np.array(torque) - np.mean(torque)
    crossings = np.flatnonzero((swing[1:] > 0) & (swing[:-1] <= 0))
    exact = crossings - swing[crossings] / (swing[crossings + 1] - swing[crossings])
    return float((len(exact) - 1) / (exact[-1] - exact[0]) / TICK)


@pytest.mark.parametrize("preload", [0.0, 5.0, 10.0])
def test_a_hardening_spring_rings_higher_under_preload(calm: TwinParameters, preload: float) -> None:
    hard = dataclasses.replace(calm, effects=Effects(stiffness=CUBIC))
    phi = by_cube(preload, calm.gear.K)
    tangent = calm.gear.K + 3 * CUBIC.cubic * phi**2
    assert frequency(hard, preload) == pytest.approx(math.sqrt(tangent / calm.gear.J_l) / (2 * math.pi), rel=1e-3)
    if preload == 10.0:
        assert tangent > 1.8 * calm.gear.K


@pytest.mark.slow
def test_stiffness_by_angle_is_met_at_every_angle(calm: TwinParameters) -> None:
    law = Stiffness(by_angle=0.08, by_angle_deg=30.0)
    for theta in np.linspace(0.0, math.pi, 7):
        plant = Plant(
            dataclasses.replace(with_gear(calm, tau_s=9.0, tau_c=9.0, F_cl=0.0), effects=Effects(stiffness=law))
        )
        plant.place(float(theta))
        plant.tau_ext = 6.0
        for _ in range(6000):
            plant.advance(TICK, 0.0)
        K = calm.gear.K * (1 + 0.08 * math.cos(2 * theta - math.radians(30.0)))
        assert plant.truth().phi == pytest.approx(6.0 / K, rel=1e-6)


def test_in_the_dead_zone_nothing_pulls(calm: TwinParameters) -> None:
    plant = Plant(
        dataclasses.replace(with_gear(calm, B_ml=0.0, B_sp=0.0, **FRICTIONLESS), effects=Effects(stiffness=GAP))
    )
    plant.place(0.0, twist=0.5 * math.radians(0.004))
    for _ in range(100):
        plant.advance(TICK, 0.0)
    assert plant.truth().tau_l == 0.0
    assert plant.motor[1] == plant.load[1] == 0.0
