"""How strong an effect is: residual with it over residual without it, same rig, same noise seed, baseline refitted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy.signal import savgol_filter

from tests.blind.builder import Builder
from tests.blind.campaign import simulate
from tests.blind.forms import Form
from tests.blind.plans import Plan
from tests.blind.residual import AROUND, AT_REST, angle_with_own_zeros, residuals, rms
from tests.blind.rig import Rig
from tests.blind.sensors import Noise
from tests.blind.taken import Taken

Excess = dict[str, float]


@dataclass(frozen=True)
class Stage:
    """Everything of a case but its effects."""

    rig: Rig
    noise: Noise
    plan: Plan
    seed: int


def over_floor(runs: list[Taken], clean: list[Taken]) -> Excess:
    """Ratio of residual RMS per channel, each run weighted by its own clean residual; 1 is nothing to see."""
    with_effect, _ = residuals(runs)
    without, _ = residuals(clean)
    out = {}
    for channel, by_run in without.items():
        both = [(with_effect[channel][name], e) for name, e in by_run.items() if name in with_effect[channel]]
        squares = [(rms(seen) / rms(e)) ** 2 for seen, e in both]
        out[channel] = float(np.sqrt(np.mean(squares)))
        out[f"{channel}_worst_run"] = float(np.sqrt(np.max(squares)))
    return out | {"reversal": at_reversals(runs, clean)}


def over_floor_with_own_zeros(runs: list[Taken], clean: list[Taken]) -> float:
    """The angle's ratio for an analysis that gives every run its own zero: what a delay shows to it is far less."""
    seen, floor = angle_with_own_zeros(runs), angle_with_own_zeros(clean)
    return float(np.sqrt(np.mean([(rms(seen[name]) / rms(e)) ** 2 for name, e in floor.items()])))


def at_reversals(runs: list[Taken], clean: list[Taken]) -> float:
    """The same for tau_m - tau_l/N where the motor turns back, compared in time; floor: scatter of clean repeats."""
    other = {run.plan.name: passing(run) for run in runs}
    change, scatter = [], []
    by_name = {run.plan.name: run for run in clean if run.plan.amplitude and not (run.plan.one_way or run.plan.locked)}
    for name, run in by_name.items():
        rows, own = turning(run), passing(run)
        change.append(np.mean((other[name] - own)[rows] ** 2))
        twin = by_name.get(name[:-2] + "_2")
        if name.endswith("_1") and twin is not None:
            scatter.append(np.mean((passing(twin) - own)[rows] ** 2) / 2)
    if not scatter:
        return 1.0
    return float(np.sqrt(1 + max(np.mean(change) / np.mean(scatter) - 2, 0)))


def passing(run: Taken) -> np.ndarray:
    """Motor torque less what the mesh passes on, smoothed, N·m."""
    return np.asarray(savgol_filter(run.columns["tau_m"] - run.columns["tau_l"] / 50.0, 21, 3))


def turning(run: Taken) -> np.ndarray:
    """Rows within `AROUND` of a motor that is (nearly) still."""
    still = np.abs(savgol_filter(run.columns["theta_m"], 21, 3, deriv=1, delta=run.plan.dt)) < AT_REST
    return np.convolve(still, np.ones(2 * round(AROUND / run.plan.dt) + 1), "same") > 0.5


def size(excess: Excess, effects: tuple[str, ...], logged: tuple[str, ...]) -> float:
    """The figure a case is drawn by: the most affected channel that is `logged`, over its floor; presliding lives at
    the reversals, which take both torques to see.
    """
    channels = [name for name in ("theta_l", "tau_l", "tau_m") if name in logged]
    turns = "presliding_friction" in effects and {"tau_l", "tau_m"} <= set(logged)
    return max(excess[name] for name in channels + ["reversal"] * turns)


BRIEF = (
    "slow_ke", "load_5nm", "load_40nm_1", "speed_60rpm_1", "speed_200rpm_1", "speed_400rpm_1", "speed_minus200rpm_1",
    "speed_120rpm", "speed_300rpm_1", "speed_500rpm_1", "lock_60_1", "load_5nm_speed_120rpm_1",
    "load_40nm_speed_120rpm_1", "load_40nm_speed_minus120rpm_1",
)  # fmt: skip


def short(plan: Plan) -> Plan:
    """A third of the runs, spread over the clock: enough to size an effect."""
    return replace(plan, runs=tuple(run for run in plan.runs if run.name.startswith(BRIEF)))


def shape_rng(seed: int, place: int) -> np.random.Generator:
    """The generator a form draws its shape from: the same at every strength."""
    return np.random.default_rng([seed, 77, place])


def calibrate(stage: Stage, form: Form, place: int, target: float, clean: list[Taken]) -> tuple[float, float]:
    """Strength at which `form` alone reaches `target` times the floor, within the form's physical bounds, and what it
    then reaches (foretold from the last try).
    """

    def excess_at(strength: float) -> float:
        return excess_of(stage, form, place, strength, clean)

    return secant(excess_at, target, form.weakest, form.strongest)


def excess_of(stage: Stage, form: Form, place: int, strength: float, clean: list[Taken]) -> float:
    """Root of (residual over floor) squared less one, of `form` alone on the short plan; grows with the strength."""
    builder = Builder(stage.rig)
    form.build(builder, shape_rng(stage.seed, place), strength)
    runs = simulate(builder, short(stage.plan), stage.noise, stage.seed)
    return float(np.sqrt(max(size(over_floor(runs, clean), (form.effect,), stage.plan.channels) ** 2 - 1, 1e-4)))


def secant(excess_at: Callable[[float], float], target: float, low: float, high: float) -> tuple[float, float]:
    """Excess power grows about as strength squared: up to three corrections along that line."""
    strength, want = min(max(1.0, low), high), np.sqrt(target**2 - 1)
    for _ in range(3):
        have = excess_at(strength)
        better = float(np.clip(strength * np.clip(want / have, 0.05, 20.0), low, high))
        change = better / strength
        strength = better
        if abs(np.log(change)) < 0.15:
            break
    return strength, float(np.sqrt(1 + (have * change) ** 2))
