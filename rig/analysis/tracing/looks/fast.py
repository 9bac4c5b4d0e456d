"""At fast rows: a mode above what the first look compares, or near the end of that, where it knows few of its sides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.rest.above_the_band import has_fast_rows, rings_above
from rig.analysis.tracing.runs.campaign import Campaign, looking, read_campaign
from rig.analysis.tracing.runs.look import Look
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effects.support_compliance import SupportCompliance
from rig.model.effects.torsional_mode import TorsionalMode

MODES: Final = frozenset({TorsionalMode.name, SupportCompliance.name})


def wanted(selected: Selected) -> bool:
    """Whether a mode is named, or something rings above what was compared; and there are rows to tell it by."""
    if not any(has_fast_rows(run) for run in selected.fitted_runs):
        return False
    return not MODES.isdisjoint(selected.names) or rings_above(selected.solution, selected.p.floors)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """All of it once more with a low-pass twice as wide. It counts where it names one mode, or the one that had a name,
    beside all else that had one, and as much is explained."""
    first = so_far.p.campaign
    again = read_campaign(first.folder, Look(fast=True))
    p = prepare(looking(again, [replace(run.look, fast=True) for run in first.runs]), hold_out)
    other, ranked = searched(p)
    beside = so_far.names - MODES
    mine = other.names & MODES
    counts = other.names == beside | mine and len(mine) == 1 and (so_far.loud or not other.loud)
    return (other, ranked) if counts else (so_far, found)
