"""Curves without a name, one after another: what unseen runs leave beside what the fitted ones foretell.

A bearing has more than one order, and a sensor's fault shows in more than one channel: one curve does not foretell all
of it. Each is read in fitted runs alone, beside those before it, and unseen runs have a veto on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.outcome.result import Curve
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.rest.foretold import unseen_beside
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.unknown import home
from rig.analysis.tracing.thresholds import EXPLAINED
from rig.model.effect import Array

MOST: Final = 4  # curves: each takes as long as the first
WORTH: Final = 0.95  # of what a channel leaves, RMS: a further curve that takes less is none to tell of


@dataclass(frozen=True)
class Unnamed:
    """What unseen runs leave beside those curves, (n,) by block; no curve where none foretells anything."""

    after: dict[Key, Array]
    curves: tuple[Curve, ...] = ()


def unnamed(p: Prepared, s: Solution, after: dict[Key, Array], first: Home) -> Unnamed:
    """The curve along `first`, and what more there is while a channel of unseen runs is loud."""
    floors = p.floors | p.held_out.floors
    left: Mapping[Key, Array] = {key: s.residual(key) for key in s.keys}
    out, where = Unnamed(after), first
    while len(out.curves) < MOST:
        mine = [key for key in after if key[1] == where.channel]
        beside = unseen_beside(p.eq, left, out.after, floors, where.channel).without(where)
        now = p.held_out.ratio(beside.unseen, mine)
        if not now < (WORTH if out.curves else 1.0) * p.held_out.ratio(out.after, mine):
            break
        curve = Curve(where.coordinate, CHANNEL[where.channel].key, where.order, where.frequency_hz, now)
        left, out = beside.fitted, Unnamed(beside.unseen, (*out.curves, curve))
        if not _loud(p, out.after) or not (more := home(p.eq, left, floors)):
            break
        where = more[0]
    return out


def _loud(p: Prepared, e: Mapping[Key, Array]) -> bool:
    """Whether a channel leaves more than may be."""
    channels = [[key for key in e if key[1] == c] for c in WHOLE]
    return any(p.held_out.ratio(e, mine) > EXPLAINED for mine in channels if mine)
