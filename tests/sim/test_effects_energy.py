"""Energy with what the paper's model lacks: every term by an independent formula, at any state and over time."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from sim import kernel
from sim.effects import Creep, Effects, Hysteresis, LoadDependentError, lines
from sim.energy import past_gap, spring_torque
from sim.parameters import TwinParameters
from sim.plant import Plant
from sim.vector import bristles, slips, unloaded
from tests.sim.conftest import with_gear
from tests.sim.everything import EVERYTHING, SECTIONS, only

TICK = 1e-3  # s
LOSSLESS = dict.fromkeys(("B_m", "B_l", "B_ml", "B_sp", "tau_c", "tau_s", "F_cl"), 0.0)


def having(parameters: TwinParameters, effects: Effects) -> TwinParameters:
    return dataclasses.replace(parameters, effects=effects)


def put(plant: Plant, rng: np.random.Generator, moving_m: bool, moving_l: bool) -> float:
    """Any state at all, written past the plant's own doors; gives the torque asked of the motor."""
    p, state = plant.parameters, plant.state
    theta_m, tau = rng.uniform(-50.0, 50.0), rng.normal(0.0, 0.5)
    load = abs(rng.normal(0.0, 3.0))
    error = kernel.kinematic_error(theta_m, load, plant.vector)
    phi = rng.normal(0.0, 8e-4)
    state[:] = 0.0
    state[[kernel.THETA_M, kernel.TAU_M, kernel.LOAD_SEEN, kernel.CLOCK]] = theta_m, tau, load, rng.uniform(0.0, 9.0)
    state[kernel.THETA_L] = theta_m / p.gear.ratio - error.value + phi
    state[[kernel.OMEGA_M, kernel.OMEGA_L]] = rng.normal(0.0, 20.0) * moving_m, rng.normal(0.0, 0.5) * moving_l
    state[[kernel.VALUE, kernel.SLOPE, kernel.PER_LOAD]] = error
    state[[kernel.CREEP_1, kernel.CREEP_2]] = rng.normal(0.0, 8e-4, 2)
    state[kernel.WARMTH] = rng.uniform(0.0, 30.0)
    s = np.array((slips(p.effects.hysteresis) + bristles(p.effects.friction))[1::2])
    state[kernel.STATE_SIZE :] = np.clip(rng.normal(0.0, 8e-4, len(s)), -s, s)
    plant.tau_ext = rng.normal(0.0, 1.0)
    plant.advance(0.0, tau)
    return float(tau)


def true_error(plant: Plant) -> tuple[float, float, float]:
    """dθ̃_p/dθ_m, dθ̃_p/dT̄ and T̄ by the series and the lines written out."""
    p, x = plant.parameters, plant.truth()
    series, e, load = p.gear.kinematic_error, p.effects.load_dependent_error, float(plant.state[kernel.LOAD_SEEN])
    fall = (unloaded(p.effects) - e.A_inf) * math.exp(-load / e.T_c)
    slope = (e.A_inf + fall) * float(series.slope(np.array(x.theta_m)))
    for order, amplitude, phase in lines(p.effects.error_lines, p.gear.ratio, p.gear.sigma):
        slope -= math.radians(amplitude) * order * math.sin(order * x.theta_m - math.radians(phase))
    return slope, -fall / e.T_c * float(series.value(np.array(x.theta_m))), load


def power_terms(plant: Plant, tau: float) -> list[float]:
    """Terms of d(T+V)/dt + dissipation − work in [W], from the formulas of the catalogue of effects."""
    p, e, x = plant.parameters, plant.parameters.effects, plant.truth()
    gear, s, hidden, t = p.gear, p.effects.stiffness, plant.hidden(), float(plant.state[kernel.CLOCK])
    (omega_m, a_m), (omega_l, a_l) = plant.motor[1:], plant.load[1:]
    slope, per_load, load = true_error(plant)
    bent, angle = past_gap(x.phi, math.radians(s.gap_deg)), s.by_angle_order * x.theta_m - math.radians(s.by_angle_deg)
    swing = gear.K * s.by_angle
    creep = [(e.creep.stiffness_1, e.creep.time_1, x.phi - hidden.creep_1)]
    creep.append((e.creep.stiffness_2, e.creep.time_2, x.phi - hidden.creep_2))
    k = (slips(e.hysteresis) + bristles(e.friction))[::2]
    torques = [k_i * wound for k_i, wound in zip(k, hidden.elements, strict=True)]
    elements, presliding = torques[: e.hysteresis.elements], torques[e.hysteresis.elements :]
    elastic = spring_torque(gear.K, e, x.phi) + swing * math.cos(angle) * bent
    elastic += sum(k * behind for k, _, behind in creep) + sum(elements)
    shrinking = per_load * (abs(elastic) - load) / e.load_dependent_error.filter
    rate = omega_l + (slope - 1.0 / gear.ratio) * omega_m + shrinking  # φ̇
    warm = math.exp(-e.friction.thermal_beta * float(plant.state[kernel.WARMTH]))
    grip = warm * (1.0 + e.assembly.friction_per_mm * e.assembly.depth_mm)
    dry = grip * (
        gear.tau_c - e.friction.presliding + (gear.tau_s - gear.tau_c) * math.exp(-((omega_m / gear.omega_s) ** 2))
    )
    f, m, w = e.friction, e.motor, e.load
    dry *= 1.0 + f.by_angle * math.cos(f.by_angle_order * x.theta_m - math.radians(f.by_angle_deg))
    dry += f.by_load * abs(elastic) / gear.ratio
    drag = f.quadratic_drag * omega_m**2 + f.two_thirds_drag * abs(omega_m) ** (2 / 3)
    return [
        gear.J_m * omega_m * a_m,
        gear.J_l * omega_l * a_l,
        elastic * rate,  # into spring, creep and elements, kept or lost
        -0.5 * swing * s.by_angle_order * math.sin(angle) * bent**2 * omega_m,  # into the spring, by the motor's angle
        -m.cogging * math.cos(m.cogging_order * x.theta_m - math.radians(m.cogging_phase_deg)) * omega_m,
        w.unbalance * math.sin(x.theta_l - math.radians(w.unbalance_phase_deg)) * omega_l,
        warm * gear.B_m * omega_m**2,
        gear.B_l * omega_l**2,
        warm * gear.B_ml * (omega_m + gear.sigma * omega_l) ** 2,
        gear.B_sp * rate**2,
        (dry + drag) * abs(omega_m),
        sum(presliding) * omega_m,  # into the bristles, kept or lost
        gear.F_cl * abs(omega_l),
        -(elastic + gear.B_sp * rate) * shrinking,  # the schedule's work
        -tau * omega_m,
        -m.ripple * tau * math.cos(m.ripple_order * x.theta_m - math.radians(m.ripple_phase_deg)) * omega_m,
        -plant.tau_ext * omega_l,
        -w.vibration * math.sin(2 * math.pi * w.vibration_hz * t + math.radians(w.vibration_phase_deg)) * omega_l,
    ]


@pytest.mark.slow
@pytest.mark.parametrize("sigma", [0, 1])
def test_power_balances_at_any_state_with_everything_on(calm: TwinParameters, sigma: int) -> None:
    plant, rng, held = Plant(with_gear(having(calm, EVERYTHING), sigma=sigma)), np.random.default_rng(1), 0
    for k in range(2000):
        tau = put(plant, rng, k % 4 in (0, 1), k % 4 in (0, 2))
        terms = power_terms(plant, tau)
        held += plant.motor[1] == plant.motor[2] == 0.0 or plant.load[1] == plant.load[2] == 0.0
        assert abs(math.fsum(terms)) <= 1e-10 * sum(map(abs, terms))
    assert held > 300


def run_with_reversals(parameters: TwinParameters, refine: float = 1.0, n: int = 3000) -> tuple[Plant, np.ndarray]:
    """Forced reversals, sticking of either side, a load that changes; rows of θ_m/N − θ_l, τ_l, heat."""
    plant, rows = Plant(parameters, theta_m=0.3, refine=refine), []
    for k in range(n):
        t = k * TICK
        plant.tau_ext = 8.0 * math.sin(2 * math.pi * 0.9 * t)
        plant.advance(TICK, 1.35 * math.sin(2 * math.pi * 2 * t) + 0.45 * math.sin(2 * math.pi * 7.3 * t))
        x = plant.truth()
        rows.append((x.theta_m / parameters.gear.ratio - x.theta_l, x.tau_l, plant.ledger().lost))
    return plant, np.array(rows)


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_energy_ledger_closes_with_each_of_them(calm: TwinParameters, section: str) -> None:
    # reached: 6e-10 to 4e-9 as the substeps are chosen
    plant, rows = run_with_reversals(having(calm, only(section)))
    assert abs(plant.ledger().residual) < 1e-7 * plant.ledger().throughput
    assert np.all(np.diff(rows[:, 2]) >= -1e-12)  # heat only ever grows


@pytest.mark.slow
def test_energy_ledger_closes_with_everything_on(twin: TwinParameters) -> None:
    plant, rows = run_with_reversals(having(twin, EVERYTHING))
    ledger = plant.ledger()
    assert abs(ledger.residual) < 1e-8 * ledger.throughput  # a hundredth of the schedule's work would show
    assert np.all(np.diff(rows[:, 2]) >= -1e-12)
    assert min(ledger.hysteresis, ledger.creep, ledger.friction_m) > 0.0
    assert abs(ledger.schedule) > 1e-6  # without its entry the ledger would not close


@pytest.mark.slow
@pytest.mark.parametrize("section", [*(pytest.param(s, marks=pytest.mark.long) for s in SECTIONS), "everything"])
def test_substeps_are_short_enough_with_each_of_them_and_converge(calm: TwinParameters, section: str) -> None:
    parameters = having(calm, EVERYTHING if section == "everything" else only(section))
    fine = run_with_reversals(parameters, 32.0, 2000)[1]
    errors = [np.abs(run_with_reversals(parameters, r, 2000)[1] - fine).max(axis=0) for r in (1.0, 4.0)]
    assert errors[0][0] < 7e-6 / 20  # rad, a twentieth of a count of the load encoder
    assert errors[0][1] < 5e-3  # N·m, of ±15
    assert np.all(errors[1][:2] < np.maximum(errors[0][:2] / 5, [1e-8, 1e-4]))


def test_elastic_terms_conserve(calm: TwinParameters) -> None:
    e = EVERYTHING
    quiet = Effects(
        stiffness=e.stiffness,
        error_lines=e.error_lines,
        motor=dataclasses.replace(e.motor, ripple=0.0),
        load=dataclasses.replace(e.load, vibration=0.0),
        hysteresis=Hysteresis(torque=60.0, twist_deg=6.0),
    )  # fmt: skip  (elements so wide that none slips)
    plant = Plant(having(with_gear(calm, **LOSSLESS), quiet))
    plant.place(0.0, omega_m=31.4, twist=1e-3)
    before = plant.energy()
    for _ in range(2000):
        plant.advance(TICK, 0.0)
    assert plant.ledger().lost == 0.0
    assert plant.energy() == pytest.approx(before, rel=1e-6)


@pytest.mark.slow
def test_left_alone_the_rig_only_loses_energy_and_comes_to_rest(calm: TwinParameters) -> None:
    e = EVERYTHING
    passive = dataclasses.replace(
        e, load=dataclasses.replace(e.load, vibration=0.0), load_dependent_error=LoadDependentError()
    )
    plant = Plant(having(calm, passive))
    plant.place(1.0, omega_m=30.0, twist=1e-3)
    energy = [plant.energy()]
    for _ in range(3000):
        plant.advance(TICK, 0.0)
        energy.append(plant.energy())
    assert np.all(np.diff(energy) <= 1e-12)
    assert (plant.truth().omega_m, plant.truth().omega_l) == (0.0, 0.0)


def test_what_load_does_to_the_error_moves_no_more_energy_than_the_spring_can_hold(calm: TwinParameters) -> None:
    plant = Plant(having(calm, Effects(load_dependent_error=LoadDependentError(A_inf=0.5, filter=0.1))))
    most = 0.0
    for k in range(5000):
        plant.tau_ext = 10.0 * math.sin(2 * math.pi * 0.5 * k * TICK)
        plant.advance(TICK, 0.6 * math.sin(2 * math.pi * 0.4 * k * TICK))
        most = max(most, abs(plant.ledger().schedule))
    swing = 0.5 * float(np.abs(calm.gear.kinematic_error.value(np.linspace(0, 6.3, 200))).max())
    assert 0.0 < most < 5 * 11.0 * swing  # torque times how far the error can shrink, once per half wave of the load


def test_a_held_torque_creeps_on_by_the_share_of_stiffness(calm: TwinParameters) -> None:
    stiff = Creep(stiffness_1=0.05 * calm.gear.K, time_1=2.0)
    plant = Plant(having(with_gear(calm, F_cl=0.0, tau_s=2.0, tau_c=2.0), Effects(creep=stiff)))
    plant.tau_ext, twist = -7.5, []  # the motor's friction holds
    for _ in range(2000):
        plant.advance(10 * TICK, 0.0)
        twist.append(-plant.truth().phi)
    at_once = 7.5 / (1.05 * calm.gear.K)
    assert twist[-1] == pytest.approx(7.5 / calm.gear.K, rel=1e-4)
    later = 2.0 * 1.05  # s, time constant at held torque: relaxation time times (K + k)/K
    half = next(k for k, x in enumerate(twist) if k > 150 and x > at_once + 0.8 * (twist[-1] - at_once)) * 10 * TICK
    assert half == pytest.approx(-math.log(0.2) * later, rel=0.02)
