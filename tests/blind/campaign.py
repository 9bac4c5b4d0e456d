"""Simulate a campaign: one rig, one set of effects, one plan, one seed. Memory, heat and time pass from run to run."""

from __future__ import annotations

import numpy as np

from tests.blind import integrate
from tests.blind.builder import ANGLE, Builder
from tests.blind.kernel import (
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
from tests.blind.plans import STROKE_SPEED, Plan, RunPlan
from tests.blind.sensors import MOTOR_COUNTS, Context, Noise, coloured, measure
from tests.blind.taken import Taken

TICK = integrate.TICK
SLOW_INNER, FAST_INNER = (
    5,
    10,
)  # steps of 200 µs and 100 µs per tick: 30 or more per period of the fastest mode (300 Hz: 17)


def triangle(n: int, amplitude: float, period: float) -> np.ndarray:
    x = np.arange(n) * TICK / period % 1.0
    return amplitude * np.where(x < 0.25, 4 * x, np.where(x < 0.75, 2 - 4 * x, 4 * x - 4))


def reference(plan: RunPlan, n: int) -> np.ndarray:
    """Motor angle asked for, rad per tick."""
    if plan.one_way:
        return STROKE_SPEED * np.arange(n) * TICK
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
    if par.extra in (1, 2, SENSOR_SHAFT):
        state[X] = state[TL] if par.extra != 1 else 0.0
        state[VX] = state[WL] if par.extra != 1 else state[W]
    state[TORQUE], state[T_SLOW] = -plan.tau_ext, abs(plan.tau_ext)


def simulate_run(
    plan: RunPlan,
    builder: Builder,
    par: Par,
    tab: Tab,
    data: np.ndarray,
    noise: Noise,
    state: np.ndarray,
    play: np.ndarray,
    seeds: list[int],
) -> Taken:
    """One run; `state` and `play` are what the rig remembers and are changed."""
    n = round((plan.lead_s + plan.duration_s) / TICK) + 1
    rng = np.random.default_rng([*seeds, 1])
    chance = np.random.default_rng([*seeds, 2])
    at_rest(state, plan, par, float(data[tab.p]))
    t = plan.start_s + np.arange(n) * TICK
    on_load = np.full(n, plan.tau_ext) + sum((wave(t) for wave in builder.load_waves), np.zeros(n))
    rub_m = noise.friction_m * coloured(rng, n, TICK, 5.0)
    rub_l = noise.friction_l * coloured(rng, n, TICK, 5.0)
    steps = builder.sensors.motor_steps
    offset = np.zeros(n) if steps is None else steps(plan.name, n, chance)
    out = np.empty((n, 6))
    inner = FAST_INNER if plan.procedure == "constant_torque" else SLOW_INNER
    guess = builder.rig.running_torque(plan.speed_rpm * 2 * np.pi / 60)
    integrate.run(
        state,
        par,
        tab,
        data,
        drive(plan),
        reference(plan, n),
        on_load,
        rub_m,
        rub_l,
        offset,
        plan.start_s,
        guess,
        inner,
        out,
        play,
    )
    first = round(plan.lead_s / TICK)
    raw = {"t": np.arange(n - first) * TICK}
    raw["theta_m"] = (out[:, 0] + read_error(builder, out[:, 0]) + offset)[first:]
    raw |= {"theta_l": out[first:, 1], "tau_l": out[first:, 2], "tau_m": out[first:, 3]}
    where = Context(plan.name, plan.start_s + plan.lead_s, chance)
    columns = measure(raw, plan.dt, builder.sensors, noise, where, np.random.default_rng([*seeds, 3]))
    return Taken(plan, columns)


def read_error(builder: Builder, angle: np.ndarray) -> np.ndarray:
    """What the motor encoder adds to the true angle, rad."""
    table = builder.tables.get("encoder_m")
    if table is None:
        return np.zeros_like(angle)
    return np.interp(np.mod(angle, 2 * np.pi), np.append(ANGLE, 2 * np.pi), np.append(table, table[0]))


def simulate(builder: Builder, plan: Plan, noise: Noise, seed: int) -> list[Taken]:
    """All runs of a campaign in the order they are taken; the same arguments give the same bytes."""
    tab, data = builder.tab()
    state, play = np.zeros(STATE_SIZE), np.zeros(max(tab.plays, 1))
    taken, clock = [], 0.0
    for number, run in enumerate(plan.runs):
        par = builder.par(run.locked)
        fade_memories(state, par, builder, run.start_s - clock)
        taken.append(simulate_run(run, builder, par, tab, data, noise, state, play, [seed, number]))
        clock = run.start_s + run.lead_s + run.duration_s
    return taken


def fade_memories(state: np.ndarray, par: Par, builder: Builder, pause_s: float) -> None:
    """What time does to heat and creep while the rig is unloaded between two runs; presliding is taken up by homing."""
    state[HEAT] *= np.exp(-pause_s / par.heat_tau)
    for i, tau in enumerate(builder.tables.get("creep_tau", ())):
        state[Z_CREEP + i] *= np.exp(-pause_s / tau)
    state[Z_FRIC : Z_FRIC + 4] = 0.0
    state[LAG] = 0.0
