"""How strong an effect is: residual with it over residual without it, same rig, same noise seed, baseline refitted to each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tests.blind.builder import Builder
from tests.blind.campaign import Taken, simulate
from tests.blind.forms import Form
from tests.blind.plans import Plan
from tests.blind.residual import AROUND, AT_REST, residuals, rms
from tests.blind.rig import Rig
from tests.blind.sensors import Noise

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
        squares = [(rms(with_effect[channel][name]) / rms(e)) ** 2 for name, e in by_run.items()]
        out[channel] = float(np.sqrt(np.mean(squares)))
        out[f"{channel}_worst_run"] = float(np.sqrt(np.max(squares)))
    return out | {"reversal": at_reversals(runs, clean)}


def at_reversals(runs: list[Taken], clean: list[Taken]) -> float:
    """The same for the motor torque where the motor turns back; the floor there is the scatter of clean repeats."""
    other = {run.plan.name: run.columns["tau_m"] for run in runs}
    change, scatter = [], []
    by_name = {run.plan.name: run for run in clean}
    for name, run in by_name.items():
        if run.plan.amplitude == 0.0 or run.plan.one_way:
            continue
        rows = turning(run)
        change.append(np.mean((other[name] - run.columns["tau_m"])[rows] ** 2))
        twin = by_name.get(name[:-2] + "_2")
        if name.endswith("_1") and twin is not None:
            scatter.append(np.mean((twin.columns["tau_m"] - run.columns["tau_m"])[rows] ** 2) / 2)
    if not scatter:
        return 1.0
    return float(np.sqrt(1 + max(np.mean(change) / np.mean(scatter) - 2, 0)))


def turning(run: Taken) -> np.ndarray:
    """Rows within `AROUND` of a motor that is (nearly) still."""
    still = np.abs(np.gradient(run.columns["theta_m"], run.plan.dt)) < AT_REST
    width = round(AROUND / run.plan.dt)
    return np.convolve(still, np.ones(2 * width + 1), "same") > 0.5


def size(excess: Excess) -> float:
    """The figure a case is drawn by: the most affected channel over its floor."""
    return max(excess[name] for name in ("theta_l", "tau_l", "tau_m", "reversal"))


def short(plan: Plan) -> Plan:
    """First repeats only: enough to size an effect at half the price."""
    return replace(plan, runs=tuple(run for run in plan.runs if not run.name.endswith(("_2", "sentinel_b"))))


def shape_rng(seed: int, place: int) -> np.random.Generator:
    """The generator a form draws its shape from: the same at every strength."""
    return np.random.default_rng([seed, 77, place])


def calibrate(stage: Stage, form: Form, place: int, target: float, clean: list[Taken]) -> float:
    """Strength at which `form` alone reaches `target` times the floor, within the form's physical bounds."""
    plan = short(stage.plan)

    def excess_at(strength: float) -> float:
        builder = Builder(stage.rig)
        form.build(builder, shape_rng(stage.seed, place), strength)
        return size(over_floor(simulate(builder, plan, stage.noise, stage.seed), clean))

    return secant(excess_at, target, form.weakest, form.strongest)


def secant(excess_at: Callable[[float], float], target: float, low: float, high: float) -> float:
    """Excess power grows about as strength squared: three corrections along that line."""
    strength, want = min(max(1.0, low), high), np.sqrt(target**2 - 1)
    for _ in range(3):
        have = np.sqrt(max(excess_at(strength) ** 2 - 1, 1e-4))
        better = float(np.clip(strength * np.clip(want / have, 0.05, 20.0), low, high))
        if abs(np.log(better / strength)) < 0.15:
            return better
        strength = better
    return strength
