"""Where what is left beside the model lives."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.free_form.along_another import along_another
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.hidden_order import hidden_order
from rig.analysis.tracing.residual.home import WHERE_IT_TURNS_BACK, Home
from rig.analysis.tracing.residual.in_the_floor import as_runs_begin, in_the_floor
from rig.analysis.tracing.residual.joined import loudness
from rig.analysis.tracing.residual.slipping_order import slipping_order
from rig.analysis.tracing.residual.unknown import home
from rig.analysis.tracing.thresholds import LITTLE, QUIET
from rig.model.effect import Array

HALF: Final = 0.5  # of the excess: a coordinate that foretells less of it may be another one's shadow


def where_left(
    p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float], one: float
) -> list[Home]:
    """Where what is left lives, the best first: a line in a sensor, then by coordinate; at reversals alone where no
    channel has more left elsewhere than may be in `one` run."""
    line = p.own.line
    elsewhere = {key: e for key, e in after.items() if key[1] != "R"}
    where = [WHERE_IT_TURNS_BACK]
    if line is not None or p.held_out.loud(elsewhere, one):
        left, seen, theirs = _left(p, s, floors, p.held_out.worst(elsewhere)[0])
        lives = home(p.eq, left, seen)
        where = lives or where
        if lives and theirs:
            where = _in_the_floor_too(p, where, left, after, {**floors, **p.held_out.floors})
            if line is None and (found := along_another(p, s, where[0])):
                where = [found, *where]
        elif lives and where[0].share < HALF and (order := slipping_order(p.eq, left, seen)):
            where = [order, *where]
    if line is not None:
        where = [Home("time_periodic", line.channel, line.share, frequency_hz=line.frequency_hz), *where]
    return where


def _left(
    p: Prepared, s: Solution, floors: Mapping[Key, float], unseen: float
) -> tuple[dict[Key, Array], Mapping[Key, float], bool]:
    """What is left in fitted runs, their floors, and whether it is theirs: of all runs, fitted anew, where fitted ones
    tell of nothing that `unseen` ones have so much of. They were too few: each load was hung but once."""
    left = {key: s.residual(key) for key in s.keys}
    if unseen < LITTLE or max(loudness(left, floors).values()) > QUIET**2:
        return left, floors, True
    every = fit(design(s.design.eq, s.design.terms, (*p.split.fitted, *p.split.held_out)))
    floors = {**floors, **p.held_out.floors}
    return {key: every.residual(key) for key in every.keys if key in floors}, floors, False


def _in_the_floor_too(
    p: Prepared, where: list[Home], left: Mapping[Key, Array], after: Mapping[Key, Array], floors: Mapping[Key, float]
) -> list[Home]:
    """The same behind what the floor itself has of it. What waves with the clock makes runs differ as well, and shows
    there first; an order that is none of the gear's is in the floor of neighbouring turns, and elsewhere only by its
    traces."""
    if where[0].coordinate == "time":
        wave = in_the_floor(p.eq, left, after, floors)
        if wave is None or not wave.frequency_hz or (where[0].first and where[0].share > wave.share):
            return where  # what settles anew in every run comes back with the runs
        if as_runs_begin(p.eq, left, floors, wave):
            return where
        return [wave, *where]
    if where[0].share < HALF:
        order = hidden_order(p.eq, left, after, floors) or slipping_order(p.eq, left, floors)
        return [order, *where] if order is not None and order.share > where[0].share else where
    return where
