"""At a gain of the motor torque: a torque constant is known to some per cent, and the torque sensor tells it better."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.covariance import is_sure
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, confounders_in
from rig.analysis.tracing.selection.selected import Selected

LEAST: Final = 0.005  # less is a torque sensor's own drift, or a loss
MOST: Final = 0.2  # more is another motor, or another unit
SURE: Final = 2.0  # times half its 95 % interval
TORQUES: Final = {"tau_m", "tau_l"}


def wanted(selected: Selected) -> bool:
    """Whether more is left than may be, or something without a name explains it (of few runs, a gain that drifts and a
    lever may stand for one that does not), and both torques were measured in a run that turns."""
    both = any(run.has >= TORQUES and not run.locked for run in selected.fitted_runs)
    return both and (selected.loud or bool(confounders_in(selected.solution)))


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """All of it once more beside a gain. It counts where the gain is sure and one a torque constant may have, and
    nothing is left: then what had a name stays, or less does, for a gain looks like a loss from one side."""
    looks = [replace(run.look, gain=True) for run in so_far.p.campaign.runs]
    p = prepare(looking(campaign, looks), hold_out)
    terms = so_far.solution.design.terms  # beside which the gain may be seen, or which stand in for it
    named = tuple(term for term in terms if term.name not in CONFOUNDERS)
    if not any(_is_a_gain(fit(design(p.eq, some, p.split.fitted))) for some in dict.fromkeys(((), named, terms))):
        return so_far, found
    other, ranked = searched(p, shown=lambda one: _is_a_gain(one.solution))
    one_in_the_other = so_far.names <= other.names or other.names <= so_far.names
    counts = _is_a_gain(other.solution) and one_in_the_other and not other.loud
    return (other, ranked) if counts else (so_far, found)


def _is_a_gain(s: Solution) -> bool:
    return is_sure(s, "gain", LEAST, SURE) and abs(s.value("gain")) < MOST
