"""Where the rest lives when no effect of the library explains it: a coordinate, an order, a frequency; no name."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from rig.analysis.tracing.fit.channels import ORDERS, WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.binned import Halves, folds, own_excess, score, straightened
from rig.analysis.tracing.residual.coordinates import FINE, INDICES, JOINT, LATE
from rig.analysis.tracing.residual.home import Home, plainest
from rig.analysis.tracing.residual.joined import Rest, loudness, rest
from rig.analysis.tracing.residual.lines import BY_THE_CLOCK, SENSES, best_order, by_the_clock, by_the_day, line
from rig.analysis.tracing.residual.own_phases import line_for_a_while, own_phases
from rig.analysis.tracing.residual.readings import accelerating, drifting, in_bins, in_columns, powers, share, swelling
from rig.analysis.tracing.residual.settling import settled
from rig.analysis.tracing.residual.sudden import since, turned_since
from rig.analysis.tracing.residual.whose_order import WHOLE_ORDER, of_the_output
from rig.analysis.tracing.residual.worn import worn_off
from rig.analysis.tracing.thresholds import ALL, PLAIN_ENOUGH
from rig.model.effect import Array

MOST = 40_000  # rows that coordinates are tried on: of a bin in five hundred there are eighty
BENT = 0.2  # of the excess, what a channel must keep beside a baseline of its own to be where the rest lives
FOLLOWS = 0.25  # of what another coordinate leaves, what a step may leave that is said before it
AS_MUCH = 0.97  # of a share: of waves that grow as the speed, in runs at 12 and 30 rad/s, its square tells 0.95
LEAST_WAY = 0.1  # of the rows at a speed, forth and back each: with fewer, single runs are all there is of one of them
WITH_TIME = ("time", "temperature")


def _warmth(r: Rest) -> Array:
    """Above the mean of what was measured, °C."""
    t = r.at["temperature"]
    known = t[np.isfinite(t)]
    return t - known.mean() if known.size else t


SMOOTH: Sequence[tuple[str, Callable[[Rest], Array]]] = (
    ("speed", lambda r: swelling(r.at["motor_angle"], np.abs(r.at["speed"]))),
    ("load", lambda r: swelling(r.at["motor_angle"], r.at["load"])),
    ("load_angle", lambda r: swelling(r.at["load_angle"], r.at["load"])),
    ("time", lambda r: drifting(r.at["time"])),
    ("temperature", lambda r: swelling(r.at["motor_angle"], _warmth(r))),
)
"""Smooth laws where bins would tell single runs apart."""


def homes(r: Rest, channel: str) -> list[Home]:
    """Coordinates by the share of the excess they predict, best first. Rows are fitted and tested on turn about."""
    seen, r = line(r, channel), r.thinned(MOST)
    h = Halves(r, folds(r))
    plain = [*INDICES.items(), *FINE]
    alone = [Home(name, channel, score(h, of(r)) / h.total, read=in_bins(of)) for name, of in plain]
    ways = [(name, index) for name, several in JOINT.items() for index in several]
    out = alone + [Home(name, channel, score(h, of(r)) / h.total, read=in_bins(of)) for name, of in ways]
    out += [Home(name, channel, score(h, of(r)) / h.total, read=in_bins(of), late=True) for name, of in LATE]
    out += [Home(name, channel, share(h, in_columns(of)), read=in_columns(of), late=True) for name, of in SMOOTH]
    if channel == "M":
        out += _read_wrong(h, max(home.share for home in out if home.late and home.coordinate == "speed"))
    for name, sense in itertools.product(("motor_angle", "load_angle"), SENSES):
        if (found := best_order(h, name, channel, sense)) is not None:
            out.append(_of_the_way(of_the_output(found, r), sense))
    if (slipping := own_phases(h, channel)) is not None:
        out.append(slipping)
    if (gone := _wound(h, channel)) is not None:
        out.append(gone)
    out += [*worn_off(h, channel), *settled(h, channel)]
    out += _frequencies(h, seen, channel)
    plainly = [other.share for other in out if not other.late and other.coordinate not in (*WITH_TIME, "memory")]
    out += _at_once(h, channel, alone, max(plainly))
    if channel == "A":
        out = _told_by_the_way(out, alone)
    if channel == "M" and _goes_both_ways(r):
        out = [replace(h, coordinate="direction") if h.coordinate == "speed" and h in alone else h for h in out]
    if not np.isfinite(r.at["temperature"]).any():
        out = [found for found in out if found.coordinate != "temperature"]
    return [replace(found, own_zeros=r.own_zeros) for found in sorted(out, key=lambda found: -found.share)]


def _goes_both_ways(r: Rest) -> bool:
    """Whether the motor does, at most of the speeds at which something is left: then a torque that is told by its speed
    without the way points one way at that speed, and friction turns with the way. It is what one way has more than the
    other."""
    level, way, left = INDICES["speed"](r), r.at["direction"], r.e**2
    there = [np.flatnonzero(level == n) for n in np.unique(level)]
    both = [min(np.mean(way[rows] > 0.5), np.mean(way[rows] < -0.5)) > LEAST_WAY for rows in there]
    seen = sum(float(left[rows].sum()) for rows, is_both in zip(there, both, strict=True) if is_both)
    return bool(seen > left.sum() / 2)


def _told_by_the_way(found: Sequence[Home], alone: Sequence[Home]) -> list[Home]:
    """What the motor's angle tells of a kinematic error beside the direction, and not by itself, is the direction's:
    all of it that comes round alike both ways is in the baseline."""
    by_itself = max((h.share for h in alone if h.coordinate == "motor_angle"), default=0.0)

    def told(h: Home) -> Home:
        beside = h.coordinate == "motor_angle" and h not in alone and h.order is None
        return replace(h, coordinate="direction") if beside and by_itself < PLAIN_ENOUGH * h.share else h

    return [told(h) for h in found]


def _of_the_way(found: Home, sense: Callable[[Rest], Array]) -> Home:
    """An order of the baseline's own kinematic error that is another one on the way back."""
    order = found.order or 0.0
    mine = found.channel == "A" and found.coordinate == "motor_angle" and sense is SENSES[1]
    known = abs(order - round(order)) < WHOLE_ORDER and 1 <= round(order) <= ORDERS
    return replace(found, coordinate="direction") if mine and known else found


def frequency(r: Rest, channel: str) -> Home | None:
    """The best of those homes that is a frequency, None where there is none."""
    seen, r = line(r, channel), r.thinned(MOST)
    return max(_frequencies(Halves(r, folds(r)), seen, channel), key=lambda found: found.share, default=None)


def _frequencies(h: Halves, seen: Home | None, channel: str) -> list[Home]:
    """`seen`: a line in runs of differing speed."""
    if not h.rest.timed:
        return []
    senses = (*SENSES, _drive) if channel == "M" else SENSES
    slow = [by_the_day(h, channel, sense) for sense in senses]
    beating = [by_the_clock(h, channel, sense, among) for sense, among in BY_THE_CLOCK]
    return [home for home in (seen, *slow, *beating, line_for_a_while(h, channel)) if home is not None]


def _drive(r: Rest) -> Array:
    """What a drive makes too much of as its gain comes and goes is a part of its torque."""
    return np.nan_to_num(r.at["motor_torque"])


def _at_once(h: Halves, channel: str, others: Sequence[Home], most: float) -> list[Home]:
    """Steps at one moment, said first of all: they have one number. Not where a coordinate by itself does nearly as
    well, or one beside the way does better, which foretells `most`: all slow runs may have been taken before all fast
    ones. Where a step leaves next to nothing, a coordinate that leaves several times as much only follows the order of
    the runs."""
    turned = turned_since(h, channel) if channel == "A" else None
    senses = (*SENSES, _load) if channel == "L" else SENSES
    steps = [step for step in (*(since(h, channel, sense) for sense in senses), turned) if step is not None]
    best = max(other.share for other in others if other.coordinate not in WITH_TIME)

    def is_first(step: Home) -> bool:
        return most < step.share and (best < PLAIN_ENOUGH * step.share or _is_it(step.share, best))

    return [replace(step, first=is_first(step)) for step in steps]


def _load(r: Rest) -> Array:
    """What an inertia that is another one from one moment on leaves of a shaft's torque is a part of it."""
    return np.nan_to_num(r.at["load"])


def _is_it(share: float, other: float) -> bool:
    """Whether one share of the excess is all of it, and what the other one leaves several times what it leaves."""
    return other < ALL and 1.0 - share < FOLLOWS * (1.0 - other)


def _read_wrong(h: Halves, at_any_size: float) -> list[Home]:
    """Waves of the motor's angle as large as the square of its speed, where they foretell as much as those of any size:
    an angle that is read wrong, or an inertia that is another one at each, and no size of its own at any speed."""
    read = in_columns(accelerating)
    home = Home("motor_angle", "M", share(h, read), read=read)
    return [home] if home.share > AS_MUCH * at_any_size else []


def _wound(h: Halves, channel: str) -> Home | None:
    """The output angle gone since the run began, which does not come round: a cable winds up. Said late: in runs of
    constant speed it is the speed and the time as well."""
    if not np.isfinite(h.rest.at["load_angle"]).all():
        return None
    read = in_columns(lambda rest: powers(rest.at["load_angle"]))
    return Home("load_angle", channel, share(h, read), read=read, late=True)


def home(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float]) -> list[Home]:
    """Best coordinates of the channel with the most left; where nothing that was fitted stands out of its floor, of the
    one of which most can be foretold: repeats differ by it, so it is in the floor."""
    if max(loudness(e, floors).values()) <= 1.0:
        rests = {c: r for c in WHOLE if (r := rest(eq, e, floors, c)) is not None}
        by_channel = [homes(r, c) for c, r in rests.items()]
        return plainest(max(by_channel, key=lambda some: some[0].share)) if by_channel else []
    most, channel = _loudest(eq, e, floors)
    if most is None:
        return []
    found = homes(most, channel)
    if channel == "L":  # its zero may wander from run to run, or a gain does that only loads of several runs show
        found += homes(replace(most, own_zeros=False), channel)
    return plainest(found)


def _loudest(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float]) -> tuple[Rest | None, str]:
    """The channel with the most left; where that is only what another one forces on it by the coefficients they share,
    the one with the most left beside a baseline of its own."""
    loud = loudness(e, floors)
    first = next(iter(loud))
    rests = {c: r for c, square in loud.items() if square > 1 and (r := rest(eq, e, floors, c)) is not None}
    if first not in rests:
        return rest(eq, e, floors, first), first
    left = {c: own_excess(r.thinned(MOST)) for c, r in rests.items()}
    if left[first] > BENT * (loud[first] - 1.0):
        return rests[first], first
    other = max(left, key=lambda c: left[c])
    return straightened(rests[other]), other
