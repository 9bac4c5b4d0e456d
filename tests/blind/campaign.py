"""Simulate a campaign: one rig, one set of effects, one plan, one seed. Memory, heat and time pass from run to run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.blind import integrate
from tests.blind.builder import ANGLE, Builder
from tests.blind.kernel import (
    COUPLING,
    DISC,
    HEAT,
    LAG,
    SENSOR_SHAFT,
    STATE_SIZE,
    T_SLOW,
    TH,
    TL,
    TORQUE,
    VX,
    WL,
    Z_CREEP,
    Z_FRIC,
    Par,
    Tab,
    W,
    X,
)
from tests.blind.plans import STAIR_S, STROKE_SPEED, Plan, RunPlan
from tests.blind.sensors import MOTOR_COUNTS, Context, Noise, coloured, measure
from tests.blind.taken import Taken

TICK = integrate.TICK
SLOW_INNER, FAST_INNER = 5, 10  # steps per tick, 200 and 100 µs: 30 and more per period of the fastest mode (150 Hz)


def triangle(n: int, amplitude: float, period: float) -> np.ndarray:
    x = np.arange(n) * TICK / period % 1.0
    return amplitude * np.where(x < 0.25, 4 * x, np.where(x < 0.75, 2 - 4 * x, 4 * x - 4))


def staircase(speeds_rpm: tuple[float, ...], n: int) -> np.ndarray:
    """The way of one speed after the other, each reached evenly within a second."""
    rows, rise = round(STAIR_S / TICK), round(1.0 / TICK)
    speed = np.repeat(np.asarray(speeds_rpm) * 2 * np.pi / 60, rows)[: n - 1]
    risen = np.convolve(np.concatenate([np.zeros(rise), speed]), np.ones(rise) / rise, "valid")[: speed.size]
    return np.concatenate([np.zeros(1), np.cumsum(risen) * TICK, np.zeros(max(n - 1 - speed.size, 0))])[:n]


def reference(plan: RunPlan, n: int) -> np.ndarray:
    """Motor angle asked for, rad per tick."""
    if plan.one_way:
        return STROKE_SPEED * np.arange(n) * TICK
    if plan.stairs_rpm:
        return staircase(plan.stairs_rpm, n)
    if plan.amplitude == 0.0:
        return np.zeros(n)
    return triangle(n, plan.amplitude, plan.lead_s + plan.duration_s)


def drive(plan: RunPlan) -> integrate.Drive:
    speed = plan.speed_rpm * 2 * np.pi / 60
    if plan.procedure == "constant_torque":
        return integrate.Drive(
            integrate.HOLD_TORQUE, 0.01, 0.02, 0.0, 0.0, MOTOR_COUNTS, 9.0, round(plan.lead_s / TICK) - 500, speed
        )
    return integrate.Drive(integrate.HOLD_ANGLE, 4.0, 40.0, 0.12, 0.12, MOTOR_COUNTS, 6.0, 0, 0.0)


def at_rest(state: np.ndarray, plan: RunPlan, par: Par, p_home: float) -> None:
    """Home position with the spring carrying the weight; steady runs are released at their speed. Memories stay."""
    state[[TH, W, TL, WL, X, VX]] = 0.0
    speed = plan.speed_rpm * 2 * np.pi / 60
    state[W], state[WL] = speed, speed / par.N
    if not plan.locked:
        state[TL] = -p_home + plan.tau_ext / par.K
    if par.extra == COUPLING:
        state[VX] = state[W]
    if par.extra in (DISC, SENSOR_SHAFT):
        state[X], state[VX] = state[TL], state[WL]
    state[TORQUE], state[T_SLOW] = -plan.tau_ext, abs(plan.tau_ext)


@dataclass
class Machine:
    """The rig while a campaign is taken: its plant, and what it remembers from run to run (`state`, `play`)."""

    builder: Builder
    noise: Noise
    tab: Tab
    data: np.ndarray
    state: np.ndarray
    play: np.ndarray


def assembled(builder: Builder, noise: Noise) -> Machine:
    tab, data = builder.tab()
    return Machine(builder, noise, tab, data, np.zeros(STATE_SIZE), np.zeros(max(tab.plays, 1)))


def disturbances(machine: Machine, plan: RunPlan, n: int, rng: np.random.Generator) -> tuple[np.ndarray, ...]:
    """Per tick: torque on the load, and friction noise of motor and load, N·m."""
    t = plan.start_s + np.arange(n) * TICK
    on_load = np.full(n, plan.tau_ext) + sum((wave(t) for wave in machine.builder.load_waves), np.zeros(n))
    rub_m = machine.noise.friction_m * coloured(rng, n, TICK, 5.0)
    rub_l = machine.noise.friction_l * coloured(rng, n, TICK, 5.0)
    return on_load, rub_m, rub_l


def simulate_run(plan: RunPlan, machine: Machine, seeds: list[int]) -> Taken:
    """One run, from before its first row; the machine's memory is changed."""
    n = round((plan.lead_s + plan.duration_s) / TICK) + 1
    noise_rng, chance, sensor_rng = (np.random.default_rng([*seeds, k]) for k in (1, 2, 3))
    builder = machine.builder
    par = builder.par(plan.locked)._replace(odd_phase=1.7 * plan.start_s)
    at_rest(machine.state, plan, par, float(machine.data[machine.tab.p]))
    steps = builder.sensors.motor_steps
    offset = np.zeros(n) if steps is None else steps(plan.name, n, chance)
    inner = FAST_INNER if plan.procedure == "constant_torque" else SLOW_INNER
    guess = builder.rig.running_torque(plan.speed_rpm * 2 * np.pi / 60) - plan.tau_ext / builder.rig.N
    out = np.empty((n, 4))
    integrate.run(
        machine.state, par, machine.tab, machine.data, drive(plan), reference(plan, n),
        *disturbances(machine, plan, n, noise_rng), offset, plan.start_s, guess, inner, out, machine.play,
    )  # fmt: skip
    first = round(plan.lead_s / TICK)
    raw = {"t": np.arange(n - first) * TICK}
    raw["theta_m"] = (out[:, 0] + read_error(builder, out[:, 0]) + offset)[first:]
    raw |= {"theta_l": out[first:, 1], "tau_l": out[first:, 2], "tau_m": out[first:, 3]}
    where = Context(plan.name, plan.start_s + plan.lead_s, chance)
    return Taken(plan, measure(raw, plan.dt, builder.sensors, machine.noise, where, sensor_rng))


def read_error(builder: Builder, angle: np.ndarray) -> np.ndarray:
    """What the motor encoder adds to the true angle, rad."""
    table = builder.tables.get("encoder_m")
    if table is None:
        return np.zeros_like(angle)
    return np.interp(np.mod(angle, 2 * np.pi), np.append(ANGLE, 2 * np.pi), np.append(table, table[0]))


def simulate(builder: Builder, plan: Plan, noise: Noise, seed: int) -> list[Taken]:
    """All runs of a campaign in the order they are taken; the same arguments give the same bytes."""
    machine = assembled(builder, noise)
    taken, clock = [], 0.0
    for number, run in enumerate(plan.runs):
        fade_memories(machine, run.start_s - clock)
        taken.append(simulate_run(run, machine, [seed, number]))
        clock = run.start_s + run.lead_s + run.duration_s
    return taken


def fade_memories(machine: Machine, pause_s: float) -> None:
    """What time does to heat and creep while the rig is unloaded between two runs; presliding is taken up by homing."""
    state = machine.state
    state[HEAT] *= np.exp(-pause_s / machine.builder.par(False).heat_tau)
    for i, tau in enumerate(machine.builder.tables.get("creep_tau", ())):
        state[Z_CREEP + i] *= np.exp(-pause_s / tau)
    state[Z_FRIC : Z_FRIC + 4] = 0.0
    state[LAG] = 0.0
