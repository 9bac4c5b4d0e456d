"""What has to be changed by hand between two runs: one thing at a time, the pin out first and in last."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from rig.campaign.steps import Item
from rig.core.operator import Change, FreeOutput, HangWeight, LockOutput, Reassemble, Rigging


@dataclass(frozen=True)
class ByHand:
    """A change to be asked for, made and shown."""

    change: Change


@dataclass(frozen=True)
class Measure:
    """A run to be made: number `index` of the campaign, from 0."""

    index: int
    item: Item


Deed = ByHand | Measure


def changes_between(now: Rigging, wanted: Rigging) -> list[Change]:
    """Pin out first, weight off before the pin goes in or the wave generator comes out, weight on and pin in last."""
    found: list[Change] = []
    refit = (now.depth_mm, now.assembly) != (wanted.depth_mm, wanted.assembly)
    other_weight = now.tau_ext != wanted.tau_ext
    if now.output_locked and (not wanted.output_locked or refit or other_weight):
        found.append(FreeOutput())
        now = found[-1].applied(now)
    if now.tau_ext and (refit or wanted.output_locked):
        found.append(HangWeight(0.0))
        now = found[-1].applied(now)
    if refit:
        found.append(Reassemble(wanted.depth_mm))
    if now.tau_ext != wanted.tau_ext:
        found.append(HangWeight(wanted.tau_ext))
    if wanted.output_locked and not now.output_locked:
        found.append(LockOutput())
    return found


def bare(rigging: Rigging) -> Rigging:
    """The same assembly with nothing on it and the output free."""
    return replace(rigging, tau_ext=0.0, output_locked=False)


def deeds(runs: Sequence[tuple[int, Item]], now: Rigging) -> Iterator[Deed]:
    """Everything to be done for `runs` (number in the campaign, run), in order, from the rig as it is `now`.

    The rig is left bare at the end: nobody comes upon a weight or a pin he does not know of.
    """
    for index, item in runs:
        for change in changes_between(now, item.rigging):
            yield ByHand(change)
        yield Measure(index, item)
        now = item.rigging
    for change in changes_between(now, bare(now)):
        yield ByHand(change)
