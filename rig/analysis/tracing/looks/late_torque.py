"""At the torque brought forward: where its reading is called late, by what a sensor's own low-pass may do.

Every torque sensor is late by something. The load's equation has a column for that; that the motor's torque or a wave
of the teeth shows it as well is no reason to call it a missing effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.aligned import LONGEST, delay_told, prepared_again
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.runs.campaign import Campaign
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.selected import Selected
from rig.analysis.tracing.thresholds import AS_WELL
from rig.model.effects.channel_time_skew import TORQUE, ChannelTimeSkew

LATE: Final = ChannelTimeSkew.name


def wanted(selected: Selected) -> bool:
    """Whether the shaft torque is called late, by no more than a low-pass may make it."""
    return LATE in selected.names and 0.0 < _delay(selected) < LONGEST


def _delay(selected: Selected) -> float:
    """By which the torque is called late, beyond what it was brought forward by, s; 0 where it is not."""
    s = selected.solution
    found = [s.x[s.design.place(i)] for i, t in enumerate(s.design.terms) if t.name == LATE and t.shape[0] == TORQUE]
    return float(found[0][0]) if found else 0.0


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The same with the torque brought forward by so much. It counts where no channel is late then, and as little is
    left."""
    late = so_far.solution.design.forward + _delay(so_far)
    again = prepared_again(so_far.p.campaign, hold_out, late_torque=late)
    if again is None:
        return so_far, found
    other, ranked = searched(again)
    if LATE in other.names or (other.loud and other.left > AS_WELL * so_far.left):
        return so_far, found
    told = replace(other.p.campaign, notes=(*other.p.campaign.notes, delay_told(other.p)))
    return replace(other, p=replace(other.p, campaign=told)), ranked
