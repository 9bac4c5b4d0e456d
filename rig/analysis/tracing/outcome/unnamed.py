"""What has no name, one after another: what unseen runs leave beside what the fitted ones foretell.

A form that acts somewhere, fitted with everything else, where there is one: what is in one sensor shows in more than
one channel. Beside those, and where there is none, curves in one channel each: a bearing has more than one order. Each
is read in fitted runs alone, beside those before it, and unseen runs have a veto on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.free_form.drawn import drawn
from rig.analysis.tracing.free_form.fitted import of_some_rows
from rig.analysis.tracing.outcome.result import Curve
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.foretold import unseen_beside
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.unknown import home
from rig.analysis.tracing.thresholds import EXPLAINED, NOTEWORTHY
from rig.model.effect import Array

MOST: Final = 4  # forms and curves: each takes as long as the first
WORTH: Final = 0.95  # of what a channel leaves, RMS: a further curve that takes less is none to tell of


@dataclass(frozen=True)
class Unnamed:
    """What unseen runs leave beside those curves, (n,) by block; no curve where none foretells anything."""

    after: dict[Key, Array]
    curves: tuple[Curve, ...] = ()


def unnamed(p: Prepared, s: Solution, after: dict[Key, Array], first: Home | None, coordinate: str | None) -> Unnamed:
    """What lies along the `first`, or where a law said it all along its `coordinate`, and what more there is while a
    channel of unseen runs is loud."""
    formed, out = _forms(p, s, Unnamed(after), first.coordinate if first else coordinate)
    if out.curves or first is None:
        s, first = formed, _next(p, formed, out)
    return _curves(p, s, out, first) if first is not None else out


def _forms(p: Prepared, s: Solution, out: Unnamed, coordinate: str | None) -> tuple[Solution, Unnamed]:
    """The model with forms, and what they leave."""
    if coordinate is not None and _loudest(p, out.after)[1] > NOTEWORTHY:
        s = of_some_rows(p, s)
    while coordinate is not None and len(out.curves) < MOST and _loudest(p, out.after)[1] > NOTEWORTHY:
        channel, _ = _loudest(p, out.after)
        found = drawn(p, s, out.after, coordinate)
        if found is None:
            break
        now = p.held_out.ratio(found.after, [key for key in found.after if key[1] == channel])
        curve = Curve(coordinate, CHANNEL[channel].key, None, None, now, found.words)
        s, out = found.solution, Unnamed(found.after, (*out.curves, curve))
        more = _next(p, s, out)
        coordinate = more.coordinate if more else None
    return s, out


def _next(p: Prepared, s: Solution, out: Unnamed) -> Home | None:
    """Where what is left beside forms lives; None where too little is, or it lives nowhere."""
    if _loudest(p, out.after)[1] <= NOTEWORTHY:
        return None
    where = home(s.design.eq, {key: s.residual(key) for key in s.keys}, p.floors | p.held_out.floors)
    return where[0] if where else None


def _curves(p: Prepared, s: Solution, out: Unnamed, where: Home) -> Unnamed:
    """The curve along `where`, and what more there is."""
    eq, floors = s.design.eq, p.floors | p.held_out.floors
    left: Mapping[Key, Array] = {key: s.residual(key) for key in s.keys}
    while len(out.curves) < MOST:
        mine = [key for key in out.after if key[1] == where.channel]
        beside = unseen_beside(eq, left, out.after, floors, where.channel).without(where)
        now = p.held_out.ratio(beside.unseen, mine)
        if not now < (WORTH if out.curves else 1.0) * p.held_out.ratio(out.after, mine):
            break
        curve = Curve(where.coordinate, CHANNEL[where.channel].key, where.order, where.frequency_hz, now)
        left, out = beside.fitted, Unnamed(beside.unseen, (*out.curves, curve))
        if _loudest(p, out.after)[1] <= EXPLAINED or not (more := home(eq, left, floors)):
            break
        where = more[0]
    return out


def _loudest(p: Prepared, e: Mapping[Key, Array]) -> tuple[str, float]:
    """The channel with most left, and its RMS over floor; 0 where only reversals were measured."""
    channels = {c: [key for key in e if key[1] == c] for c in WHOLE}
    over = {c: p.held_out.ratio(e, mine) for c, mine in channels.items() if mine}
    return max(over.items(), key=lambda item: item[1], default=("", 0.0))
