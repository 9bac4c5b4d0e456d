"""In which order the runs are made: random where it costs no hand change, sentinels at start, middle and end."""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable, Sequence
from dataclasses import replace

from rig.campaign.steps import Item
from rig.core.operator import Rigging

Length = Callable[[Item], float]  # s of rig time


def shuffled(items: list[Item], seed: int) -> list[Item]:
    """Runs that need the same rigging and follow one another, in random order: all first repeats, then all second …

    Hand changes stay where the plan has them: a load sweep goes up and down as written.
    """
    draw = random.Random(seed)
    found: list[Item] = []
    for _, block in itertools.groupby(items, key=lambda item: item.rigging):
        rounds: dict[int, list[Item]] = {}
        for item in block:
            rounds.setdefault(item.repeat, []).append(item)
        for repeat in sorted(rounds):
            draw.shuffle(rounds[repeat])
            found += rounds[repeat]
    return found


def with_sentinels(items: list[Item], sentinel: list[Item], moments: Sequence[str], length: Length) -> list[Item]:
    """The sentinel put in at its moments, in whatever assembly the rig then is."""
    places = {"start": 0, "middle": middle(items, length), "end": len(items)}
    found = list(items)
    for moment in sorted(set(moments), key=lambda moment: -places[moment]):
        number = places[moment]
        beside = items[number if moment == "start" else number - 1].rigging
        rigging = Rigging(0.0, False, beside.depth_mm, beside.assembly)
        found[number:number] = [
            replace(one, rigging=rigging, note=one.note or f"sentinel, {moment}") for one in sentinel
        ]
    return found


def middle(items: list[Item], length: Length) -> int:
    """Before which run half of the time is over; a place where the output is free and unloaded anyway, if there is one.

    Such a place counts as good when it lies within a quarter of the total time from the middle.
    """
    ends = [0.0, *itertools.accumulate(length(item) for item in items)]
    half = ends[-1] / 2

    def far(k: int) -> float:
        return abs(ends[k] - half)

    inner = range(1, max(len(items), 2))  # not before the first run: that is the start
    easy = [k for k in inner if any(_bare(item) for item in items[k - 1 : k + 1])]
    near = [k for k in easy if far(k) <= half / 2]
    return min(near or list(inner), key=far)


def _bare(item: Item) -> bool:
    return item.rigging.tau_ext == 0.0 and not item.rigging.output_locked
