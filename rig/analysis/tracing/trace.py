"""One trace from a folder to a result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from rig.analysis.tracing.bank import fill, reach
from rig.analysis.tracing.campaign import Campaign, read_campaign
from rig.analysis.tracing.channels import known_of
from rig.analysis.tracing.equations import Equations, Noise, equations, spoiling
from rig.analysis.tracing.holdout import Split, split
from rig.analysis.tracing.judge import Court, convicted, court, unseen
from rig.analysis.tracing.model import Solution, design, fit
from rig.analysis.tracing.noise import Measured, floor_of, guess, measure
from rig.analysis.tracing.report import report
from rig.analysis.tracing.result import Trace
from rig.analysis.tracing.search import search
from rig.core.errors import UsageError
from rig.model.effects import CATALOGUE


@dataclass(frozen=True)
class Prepared:
    """The baseline fitted, the floor measured, nothing added yet."""

    campaign: Campaign
    split: Split
    eq: Equations
    measured: Measured
    baseline: Solution
    court: Court


def trace(folder: Path, hold_out: Sequence[str] = ()) -> Trace:
    """Trace the campaign in `folder`. Raises UsageError when it cannot be read or has too little to fit and test."""
    p = prepare(read_campaign(folder), hold_out)
    keys = p.eq.of(p.split.fitted)
    covered = reach([p.eq.runs[i] for i in p.split.fitted])
    bank = fill(p.eq, list(CATALOGUE.values()), p.split.fitted, covered)
    floors = {key: floor_of(p.measured, p.eq, key) for key in keys}
    found = search(p.baseline.design, bank, p.split.fitted, keys, covered, floors)
    solution, held, worths = convicted(found.solution, p.court)
    return report(p, found, solution, held, worths)


def prepare(campaign: Campaign, hold_out: Sequence[str]) -> Prepared:
    """Split, fit the baseline, measure the floor, fit again."""
    parts = split(campaign.runs, hold_out)
    eq = equations(parts.runs, Noise({}, {}, {}))
    if not eq.of(parts.fitted) or not eq.of(parts.held_out):
        raise UsageError(
            f"{campaign.name}: no run to fit or none to test with has two angles, or an angle and a torque"
        )
    eq = spoiling(replace(eq, noise=guess(eq)), parts.fitted)
    for _ in range(2):
        s = fit(design(eq, (), parts.fitted))
        measured = measure(eq, {key: s.residual(key) for key in s.keys}, parts.fitted)
        eq = replace(eq, noise=measured.noise)
        if s.value("compliance") > 0:
            eq = eq.knowing(known_of(s.values))
    s = fit(design(eq, (), parts.fitted))
    return Prepared(campaign, parts, eq, measured, s, court(eq, measured, parts.held_out))


__all__ = ["Prepared", "prepare", "trace", "unseen"]
