"""Energy: none appears, none is lost unaccounted for, with every term that dissipates switched on."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rig.model.gear import Gear
from sim import kernel
from sim.parameters import TwinParameters
from sim.plant import Plant
from tests.sim.conftest import with_gear

TICK = 1e-3  # s


def put(plant: Plant, theta_m: float, omega_m: float, twist: float, omega_l: float, tau_m: float) -> None:
    """Any state at all, written past the plant's own doors; `twist` is φ in rad."""
    series = plant.parameters.gear.kinematic_error
    value, slope = float(series.value(np.array(theta_m))), float(series.slope(np.array(theta_m)))
    plant.state[:] = 0.0
    plant.state[[kernel.THETA_M, kernel.OMEGA_M, kernel.OMEGA_L, kernel.TAU_M]] = theta_m, omega_m, omega_l, tau_m
    plant.state[kernel.THETA_L] = theta_m / plant.parameters.gear.ratio - value + twist
    plant.state[[kernel.VALUE, kernel.SLOPE]] = value, slope
    plant.advance(0.0, tau_m)


def stribeck(gear: Gear, omega: float) -> float:
    return gear.tau_c + (gear.tau_s - gear.tau_c) * math.exp(-((omega / gear.omega_s) ** 2))


def power_terms(plant: Plant) -> tuple[list[float], bool]:
    """Terms of d(T+V)/dt + dissipation − work in [W], and whether a side is held."""
    gear, x = plant.parameters.gear, plant.truth()
    omega_m, a_m = plant.motor[1:]
    omega_l, a_l = plant.load[1:]
    slope = float(gear.kinematic_error.slope(np.array(x.theta_m)))
    twist_rate = omega_l - omega_m / gear.ratio + slope * omega_m
    terms = [
        gear.J_m * omega_m * a_m,
        gear.J_l * omega_l * a_l,
        gear.K * x.phi * twist_rate,
        gear.B_m * omega_m**2,
        gear.B_l * omega_l**2,
        gear.B_ml * (omega_m + gear.sigma * omega_l) ** 2,
        gear.B_sp * twist_rate**2,
        stribeck(gear, omega_m) * abs(omega_m),
        gear.F_cl * abs(omega_l),
        -x.tau_m * omega_m,
        -plant.tau_ext * omega_l,
    ]
    return terms, (omega_m == 0.0 and a_m == 0.0) or (omega_l == 0.0 and a_l == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0, 1])
def test_power_balances_at_any_state_with_every_loss_on(calm: TwinParameters, sigma: int) -> None:
    plant, rng, held = Plant(with_gear(calm, sigma=sigma)), np.random.default_rng(1), 0
    for k in range(2000):
        moving_m, moving_l = k % 4 in (0, 1), k % 4 in (0, 2)
        plant.tau_ext = rng.normal(0.0, 1.0)
        put(
            plant,
            theta_m=rng.uniform(-50.0, 50.0),
            omega_m=rng.normal(0.0, 20.0) * moving_m,
            twist=rng.normal(0.0, 2e-4),
            omega_l=rng.normal(0.0, 0.5) * moving_l,
            tau_m=rng.normal(0.0, 0.5),
        )
        terms, is_held = power_terms(plant)
        held += is_held
        assert abs(math.fsum(terms)) <= 1e-10 * sum(map(abs, terms))  # rounding of θ_m/N, times K, is what is left
    assert held > 500


@pytest.mark.parametrize("sigma", [0, 1])
def test_equations_six_and_seven_hold_term_by_term(calm: TwinParameters, sigma: int) -> None:
    plant, rng = Plant(with_gear(calm, sigma=sigma)), np.random.default_rng(2)
    g = plant.parameters.gear
    for _ in range(300):
        plant.tau_ext = rng.normal(0.0, 5.0)
        put(plant, rng.uniform(-9, 9), rng.normal(0, 30), rng.normal(0, 1e-3), rng.normal(0, 0.6), rng.normal(0, 2))
        x, lever = plant.truth(), float(g.kinematic_error.slope(plant.state[kernel.THETA_M])) - 1 / g.ratio
        twist_rate = x.omega_l + lever * x.omega_m
        mesh = g.B_ml * (x.omega_m + sigma * x.omega_l)
        friction = math.copysign(stribeck(g, x.omega_m), x.omega_m)
        left = g.J_m * plant.motor[2] + g.K * x.phi * lever + g.B_m * x.omega_m + mesh + g.B_sp * twist_rate * lever
        assert left + friction == pytest.approx(x.tau_m, abs=1e-12)
        left = g.J_l * plant.load[2] + g.K * x.phi + g.B_l * x.omega_l + sigma * mesh + g.B_sp * twist_rate
        assert left + math.copysign(g.F_cl, x.omega_l) == pytest.approx(plant.tau_ext, abs=1e-11)
        # the sensor sees all the gear gives to the load
        expected = -g.K * x.phi - g.B_sp * twist_rate - sigma * mesh
        assert plant.shaft[1] == pytest.approx(expected, abs=1e-11)


def run_with_reversals(parameters: TwinParameters, refine: float = 1.0) -> tuple[Plant, list[float]]:
    """3 s of forced reversals, sticking of either side, a load that changes, friction that wanders."""
    plant, rng, heat = Plant(parameters, theta_m=0.3, refine=refine), np.random.default_rng(5), [0.0]
    for k in range(3000):
        t = k * TICK
        plant.tau_ext = 3.0 * math.sin(2 * math.pi * 0.9 * t)
        tau = 0.9 * math.sin(2 * math.pi * 2 * t) + 0.3 * math.sin(2 * math.pi * 7.3 * t)
        plant.advance(TICK, tau, *rng.standard_normal(2))
        heat.append(plant.ledger().lost)
    return plant, heat


@pytest.mark.slow
def test_energy_ledger_closes_over_reversals_and_sticking(twin: TwinParameters) -> None:
    # reached: 2e-8 as the substeps are chosen, 5e-10 with substeps a quarter as long (fourth order: both shrink on)
    plant, _ = run_with_reversals(twin)
    ledger = plant.ledger()
    assert ledger.throughput > 1.0
    assert abs(ledger.residual) < 1e-7 * ledger.throughput
    fine = run_with_reversals(twin, refine=4.0)[0].ledger()
    assert abs(fine.residual) < 1e-9 * fine.throughput


@pytest.mark.parametrize(("rpm", "share"), [(9.6, 2e-7), (120.0, 1e-8), (300.0, 1e-9), (500.0, 1e-9)])
def test_energy_ledger_closes_at_speed(calm: TwinParameters, rpm: float, share: float) -> None:
    plant, omega = Plant(calm), rpm * math.pi / 30
    plant.place(0.3, omega)
    for _ in range(2000):
        plant.advance(TICK, 0.32 + 3.3e-3 * omega + 0.05 * (omega - plant.motor[1]))
    ledger = plant.ledger()
    assert abs(ledger.residual) < share * ledger.throughput


def test_every_loss_only_ever_grows(twin: TwinParameters) -> None:
    plant, heat = run_with_reversals(twin)
    assert np.all(np.diff(heat) >= -1e-15)
    assert min(dataclasses.astuple(plant.ledger())[2:8]) > 0.0


def test_left_alone_the_rig_only_loses_energy_and_comes_to_rest(calm: TwinParameters) -> None:
    plant = Plant(calm)
    plant.place(1.0, omega_m=30.0, twist=1e-3)
    energy = [plant.energy()]
    for _ in range(3000):
        plant.advance(TICK, 0.0)
        energy.append(plant.energy())
    assert np.all(np.diff(energy) <= 1e-15)
    assert plant.truth()[1] == 0.0
    assert plant.truth()[3] == 0.0


def test_wandering_friction_never_pushes(twin: TwinParameters) -> None:
    wild = dataclasses.replace(twin, friction_noise=3.0)  # far beyond its mean: the wander is clipped at no friction
    plant, heat = run_with_reversals(wild)
    assert np.all(np.diff(heat) >= -1e-15)
    assert abs(plant.ledger().residual) < 1e-6 * plant.ledger().throughput


def test_without_losses_energy_stays(calm: TwinParameters) -> None:
    none = dict.fromkeys(("B_m", "B_l", "B_ml", "B_sp", "tau_c", "tau_s", "F_cl"), 0.0)
    plant = Plant(with_gear(calm, **none))
    plant.place(0.0, omega_m=31.4, twist=2e-4)
    before = plant.energy()
    for _ in range(2000):
        plant.advance(TICK, 0.0)
    assert plant.energy() == pytest.approx(before, rel=1e-6)  # 60 000 radians of the highest order


def test_a_falling_load_turns_height_into_speed(calm: TwinParameters) -> None:
    none = dict.fromkeys(("B_m", "B_l", "B_ml", "B_sp", "tau_c", "tau_s", "F_cl"), 0.0)
    plant = Plant(with_gear(calm, **none))
    plant.place(0.0)
    plant.tau_ext = 2.0
    start = plant.truth().theta_l
    for _ in range(1000):
        plant.advance(TICK, 0.0)
    gear, x = calm.gear, plant.truth()
    assert plant.energy() == pytest.approx(2.0 * (x.theta_l - start), rel=1e-7)
    together = gear.J_l + gear.ratio**2 * gear.J_m
    assert x.omega_l == pytest.approx(2.0 / together * 1.0, rel=0.05)  # the rigid rig, but for the spring's swing
