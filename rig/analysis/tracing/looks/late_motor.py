"""At a motor torque that is told a little before it acts, or after: a drive says what it sets, and its current follows;
or it averages its current over a cycle, and says it then.

At the constant torques and slow triangles of a campaign that shows nowhere. In a sweep up to 40 Hz 0.3 ms are some five
times the floor, and follow no effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.late_reading import is_late
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import PLAIN_ENOUGH

NEEDED: Final = {"tau_m", "tau_l", "theta_m", "t"}


def wanted(selected: Selected) -> bool:
    """Whether more is left than may be, and both torques were measured in a run that turns."""
    return selected.loud and any(run.has >= NEEDED and not run.locked for run in selected.fitted_runs)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """All of it once more beside a delay. It counts where the delay is sure and as short as a drive's, all that had a
    name has it still, and nothing is left, or of the motor's torque clearly less."""
    looks = [replace(run.look, late_motor=True) for run in so_far.p.campaign.runs]
    p = prepare(looking(so_far.p.campaign, looks), hold_out)
    if not any(is_late(fit(design(p.eq, terms, p.split.fitted))) for terms in ((), so_far.solution.design.terms)):
        return so_far, found
    other, ranked = searched(p, shown=lambda one: is_late(one.solution))
    less = not other.loud or _left(other) < PLAIN_ENOUGH * _left(so_far)
    counts = is_late(other.solution) and so_far.names <= other.names and less
    return (other, ranked) if counts else (so_far, found)


def _left(selected: Selected) -> float:
    """RMS over floor of the motor's torque in held-out runs."""
    held_out = selected.p.held_out
    e = held_out.residuals(selected.solution, selected.held)
    return held_out.ratio(e, [key for key in e if key[1] == "M"])
