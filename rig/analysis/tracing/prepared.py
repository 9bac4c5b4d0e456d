"""What a trace begins with: the runs split, the baseline fitted, the floor measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

from rig.analysis.tracing.fit.channels import CHANNELS, ORDERS
from rig.analysis.tracing.fit.equations import Equations, Key, Noise, equations, spoiling
from rig.analysis.tracing.fit.leaning import carrying
from rig.analysis.tracing.fit.learnt import change, learnt
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.fit.negative import refuse_negative
from rig.analysis.tracing.fit.scale import off_scale
from rig.analysis.tracing.fit.search import ROUNDS, SETTLED
from rig.analysis.tracing.floor.held_out import HeldOut, held_out_blocks
from rig.analysis.tracing.floor.noise import Measured, guess, measure, of_sensors
from rig.analysis.tracing.floor.of_a_run import floor_of
from rig.analysis.tracing.floor.own import Own, find
from rig.analysis.tracing.runs.answered import KEPT, slow_enough, too_fast
from rig.analysis.tracing.runs.campaign import Campaign
from rig.analysis.tracing.runs.holdout import Split, split
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.weights import refuse_odd_torques
from rig.core.errors import UsageError
from rig.core.units import RPM

FEWEST: Final = 250  # rows, eight for each number of a kinematic error


@dataclass(frozen=True)
class Prepared:
    """The baseline fitted and the floor measured. `eq` has the columns of the effects in `own`, which every run shows
    in its own way; `bare` has none."""

    campaign: Campaign
    split: Split
    bare: Equations
    eq: Equations
    measured: Measured
    first: Measured  # the same beside the baseline alone
    baseline: Solution
    held_out: HeldOut
    own: Own

    @cached_property
    def floors(self) -> dict[Key, float]:
        """Of the fitted blocks."""
        return {key: floor_of(self.measured, self.eq, key) for key in self.eq.of(self.split.fitted)}

    @cached_property
    def silence(self) -> dict[Key, float]:
        """Floors of the fitted blocks below which nothing more is looked for. What repeats of the load torque differ by
        far beyond the noise of the readings is of a rig that answers otherwise each time: it may be what is missing."""
        sensors = {key: of_sensors(self.eq, self.measured.white, *key) for key in self.floors if key[1] == "L"}
        most = {key: self.measured.beyond * rms for key, rms in sensors.items() if rms}
        return {key: min(floor, most.get(key, floor)) for key, floor in self.floors.items()}


def prepare(campaign: Campaign, hold_out: Sequence[str], swapped: bool = False) -> Prepared:
    """Split, fit the baseline, measure the floor, look for what each run has to itself, fit again. `swapped`: other
    repeats are held out than usual."""
    parts = split(campaign.runs, hold_out, swapped)
    eq = equations(parts.runs, Noise({}, {}, {}))
    if not eq.of(parts.fitted) or not eq.of(parts.held_out):
        raise UsageError(f"{campaign.name}: {_nothing(eq.runs)}")
    _refuse_too_short(eq, parts.fitted, campaign.name)
    refuse_odd_torques(campaign.runs, campaign.name)
    if all(_is_still(eq.runs[i]) for i in parts.fitted):
        said = f" ({'; '.join(campaign.notes)[:300]})" if campaign.notes else ""
        raise UsageError(
            f"{campaign.name}: no run to fit whose output is free and whose motor turns, expected one{said}"
        )
    eq = spoiling(replace(eq, noise=guess(eq)), parts.fitted)
    s = fit(design(eq, (), parts.fitted))
    refuse_negative(s, campaign.name)
    campaign = replace(campaign, notes=(*campaign.notes, *off_scale(s, campaign.name)))
    measured = measure(s, parts.fitted)
    eq = replace(eq, noise=measured.noise)
    eq = eq.knowing(learnt(s)).leaning_on_it()
    s = fit(design(eq, (), parts.fitted))
    eq, s = _settled(eq, s, parts.fitted)
    own = find(s, parts)
    if columns := own.columns():
        s = fit(design(replace(eq, own=columns), (), parts.fitted))
    return built(campaign, parts, eq, measure(s, parts.fitted), own)


def _is_still(run: Recording) -> bool:
    """Whether neither side of it turns freely, nor is it wound up from the output by a torque that was read."""
    return run.procedure == "standstill" or (run.locked and not run.input_locked)


def _nothing(runs: Sequence[Recording]) -> str:
    """Why no equation holds in any row."""
    if fast := [run for run in runs if too_fast(run)]:
        side, limit = "load" if "theta_m" in fast[0].has else "motor", slow_enough(fast[0]) / RPM
        return (
            f"nobody read how the {side} moves, and {fast[0].name} swings too fast to know it: at some angles of the "
            f"motor it is never slower than {limit / KEPT:.0f} rpm, below which the {side} moves as stiffly as the "
            "other side; runs at even speeds, slower ones, or both angles can be traced"
        )
    return "no run to fit, or none to test with, has two angles or an angle and a torque"


def _refuse_too_short(eq: Equations, fitted: Sequence[int], name: str) -> None:
    """Raises UsageError where the fitted runs have hardly more rows than the baseline has coefficients."""
    rows = max(sum(eq.rows[key].y.size for key in eq.of(fitted) if key[1] == c) for c in CHANNELS)
    if rows < FEWEST:
        apart = eq.runs[fitted[0]].smoother.dt * eq.runs[fitted[0]].smoother.step  # s
        raise UsageError(
            f"{name}: what can be fitted lasts {rows * apart:.2g} s, {rows} rows at {1 / apart:.0f} Hz, expected at "
            f"least {FEWEST}: a kinematic error of {ORDERS} orders has {2 * ORDERS} numbers, and the floor is read "
            "from what is left of them"
        )


def _settled(eq: Equations, s: Solution, runs: Sequence[int]) -> tuple[Equations, Solution]:
    """Of a load whose torque nobody read, until what its friction and inertia do to the angle is what they do beside
    the spring that is found: its columns are made with the one that was known before."""
    for _ in range(ROUNDS if any(eq.runs[i].load_unread for i in runs) else 0):
        now = learnt(s)
        if change(eq.runs[runs[0]].gear, now) < SETTLED:
            break
        eq = eq.knowing(now).leaning_on_it()
        s = fit(design(eq, (), runs))
    return eq, s


def built(campaign: Campaign, parts: Split, bare: Equations, measured: Measured, own: Own) -> Prepared:
    """With baseline and held-out blocks beside the floor `measured`; `bare` are the equations without any `own`. What
    effects take of a load is no business of the baseline's."""
    bare = replace(bare, noise=measured.noise, own={})
    eq = replace(bare, own=own.columns())
    bare = carrying(bare, ())
    baseline = fit(design(bare, (), parts.fitted))
    return Prepared(
        campaign, parts, bare, eq, measured, measured, baseline, held_out_blocks(eq, measured, parts.held_out), own
    )
