"""At the zeros of runs: where one zero would do for all, what shifts it with speed is a reading that comes late."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.floor.homed import about_a_line, torque_zero
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import Campaign, looking
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.confounders import confounders_in
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effects.channel_time_skew import ChannelTimeSkew

LATE: Final = ChannelTimeSkew.name


def wanted(selected: Selected) -> bool:
    """Whether the zeros lie about a line over speed, and no channel is called late. Not beside a law without a name:
    the faster a run is, the further it winds up a cable, and so go the zeros of its torques."""
    if LATE in selected.names or confounders_in(selected.solution):
        return False
    return about_a_line(selected.solution) is not None


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The same where what shifts a run's zero is no zero of its own. It counts where it names a reading that comes late
    and nothing else more, and explains everything."""
    scatter = about_a_line(so_far.solution) or 0.0
    looks = [replace(run.look, zeros=scatter) for run in so_far.p.campaign.runs]
    there = with_torque_zeros(looking(campaign, looks), so_far.solution)
    other, ranked = searched(
        prepare(there, hold_out), frozenset({LATE}), lambda one: LATE in one.names or one.left < so_far.left
    )
    late = not other.loud and other.names == {LATE, *so_far.names}
    return (other, ranked) if late else (so_far, found)


def with_torque_zeros(campaign: Campaign, s: Solution) -> Campaign:
    """The same runs, the zero that their torque sensor has in the load's balance of `s` taken off: it winds nothing up,
    and would shift the zero of the angles."""
    eq = s.design.eq
    found: dict[str, list[float]] = {}
    for i, run in enumerate(eq.runs):
        if not run.locked:
            found.setdefault(whole_run(run.name), []).append(torque_zero(s, i))

    def shifted(run: Recording) -> Recording:
        zero = float(np.mean(found.get(run.name, [0.0])))
        pieces = (replace(piece, torque=piece.torque - zero, tau_l=piece.tau_l - zero) for piece in run.pieces)
        return replace(run, pieces=tuple(pieces)) if zero else run

    return replace(campaign, runs=tuple(shifted(run) for run in campaign.runs))
