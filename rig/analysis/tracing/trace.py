"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rig.analysis.tracing.bank import fill, reach
from rig.analysis.tracing.campaign import Campaign, read_campaign
from rig.analysis.tracing.channels import known_of
from rig.analysis.tracing.equations import Equations, Key, Noise, equations, spoiling
from rig.analysis.tracing.floor import repeats
from rig.analysis.tracing.holdout import Split, split
from rig.analysis.tracing.judge import Court, convicted, court
from rig.analysis.tracing.local import (
    Vibration,
    explained,
    find_steps,
    find_vibration,
    lost_counts,
    orthonormal,
    step_columns,
    vibration_columns,
)
from rig.analysis.tracing.model import Solution, design, fit
from rig.analysis.tracing.noise import Measured, floor_of, guess, measure
from rig.analysis.tracing.report import report
from rig.analysis.tracing.result import Trace
from rig.analysis.tracing.search import Found, polished, search, still
from rig.analysis.tracing.thresholds import OWN
from rig.core.errors import UsageError
from rig.model.effect import Array, Parameter
from rig.model.effects import CATALOGUE


@dataclass(frozen=True)
class Prepared:
    """The baseline fitted, the floor measured, nothing added yet. `bare` has no local columns, `eq` has those of the
    effects in `own`, which every run shows in its own way."""

    campaign: Campaign
    split: Split
    bare: Equations
    eq: Equations
    measured: Measured
    baseline: Solution
    court: Court
    own: dict[str, tuple[Parameter, ...]]
    line: Vibration | None  # a line at a fixed frequency that is no torque on the load


def trace(folder: Path, hold_out: Sequence[str] = ()) -> Trace:
    """Trace the campaign in `folder`. Raises UsageError when it cannot be read or has too little to fit and test."""
    p = prepare(read_campaign(folder), hold_out)
    keys = p.eq.of(p.split.fitted)
    floors = {key: floor_of(p.measured, p.eq, key) for key in keys}
    start = fit(design(p.eq, (), p.split.fitted))
    found = Found(start, ())
    covered = reach([p.eq.runs[i] for i in p.split.fitted])
    if not still(start, floors):
        bank = fill(p.eq, list(CATALOGUE.values()), p.split.fitted, covered)
        found = search(start.design, bank, p.split.fitted, keys, covered, floors)
    solution, held, worths = convicted(found.solution, p.court)
    if len(solution.design.terms) < len(found.solution.design.terms) or len(solution.design.terms) > 1:
        solution = polished(solution, p.split.fitted, covered)
        solution, held, worths = convicted(solution, p.court)
    return report(p, found, solution, held, worths)


def prepare(campaign: Campaign, hold_out: Sequence[str]) -> Prepared:
    """Split, fit the baseline, measure the floor, look for what each run has to itself, fit again."""
    parts = split(campaign.runs, hold_out)
    eq = equations(parts.runs, Noise({}, {}, {}))
    if not eq.of(parts.fitted) or not eq.of(parts.held_out):
        raise UsageError(
            f"{campaign.name}: no run to fit, or none to test with, has two angles or an angle and a torque"
        )
    eq = spoiling(replace(eq, noise=guess(eq)), parts.fitted)
    s = fit(design(eq, (), parts.fitted))
    measured = measure(eq, {key: s.residual(key) for key in s.keys}, parts.fitted)
    eq = replace(eq, noise=measured.noise)
    if s.value("compliance") > 0:
        eq = eq.knowing(known_of(s.values))
    local, own, line = _local(eq, parts)
    with_own = replace(eq, local=local)
    s = fit(design(with_own, (), parts.fitted))
    measured = measure(with_own, {key: s.residual(key) for key in s.keys}, parts.fitted)
    eq, with_own = replace(eq, noise=measured.noise), replace(with_own, noise=measured.noise)
    s = fit(design(eq, (), parts.fitted))
    return Prepared(campaign, parts, eq, with_own, measured, s, court(with_own, measured, parts.held_out), own, line)


def _local(eq: Equations, parts: Split) -> tuple[dict[Key, Array], dict[str, tuple[Parameter, ...]], Vibration | None]:
    """Columns each run has to itself, and the effects they stand for; found on fitted runs, given to all."""
    s = fit(design(eq, (), parts.fitted))
    e = {key: s.residual(key) for key in s.keys}
    made: list[dict[Key, Array]] = []
    own: dict[str, tuple[Parameter, ...]] = {}
    line = find_vibration(eq, e)
    if line is not None and line.of_the_load(1 / s.value("compliance") if s.value("compliance") > 0 else np.inf):
        made.append(vibration_columns(eq, line.frequency_hz))
        own["external_vibration"] = line.parameters()
        line = None
    if lost_counts(eq, find_steps(eq, e), repeats(eq.runs, parts.fitted)):
        held = design(replace(eq, noisy={}), (), parts.held_out)
        everywhere = find_steps(eq, e | {key: held.residual(key, s.x) for key in held.y})
        columns = step_columns(eq, everywhere)
        if explained(eq, e, columns) > OWN:
            made.append(columns)
            own["missed_counts"] = everywhere.parameters()
    return orthonormal(eq, made), own, line
