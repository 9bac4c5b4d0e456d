"""The figures at the head of the page: error before and after on held-out runs, with interval and floor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rig.analysis.tracing.result import Status, Trace
from rig.report.figures.arrays import line
from rig.report.numbers import estimate, join, plain
from rig.report.trace.channels import CHANNELS, Channel


class Card(NamedTuple):
    """One channel: error before → after, as ratio to the floor, and what it was measured on."""

    label: str
    before: str
    after: str  # "" where nothing was added
    unit: str
    ratio: str
    how: str
    main: bool  # where the most was left


def cards(trace: Trace) -> list[Card]:
    """A card for each channel that was measured, the one with most left first."""
    found = [c for c in CHANNELS if c.sensor in trace.ratios_before]
    found.sort(key=lambda c: -trace.ratios_before[c.sensor])
    return [_card(trace, c, i == 0) for i, c in enumerate(found)]


def _card(trace: Trace, channel: Channel, main: bool) -> Card:
    alone = trace.verdict.status is Status.NOTHING
    before, after = channel.error(trace.before.pooled), channel.error(trace.after.pooled)
    floor = channel.floor(trace.before.pooled)
    ratios = trace.ratios_before[channel.sensor], trace.ratios_after.get(channel.sensor)
    ratio = f"{plain(ratios[0], 3)} × the floor"
    if not alone and ratios[1] is not None:
        ratio = f"{plain(ratios[0], 3)} → {plain(ratios[1], 3)} × the floor"
    how = f"RMS of measured less model over {len(trace.held_out)} held-out runs"
    how += f"; floor {join(plain(floor, 3), channel.unit)}, what repeats differ by" if floor is not None else ""
    return Card(
        channel.name,
        _said(trace, channel, "before", before),
        "" if alone else _said(trace, channel, "after", after),
        channel.unit,
        ratio,
        how + ".",
        main,
    )


def _said(trace: Trace, channel: Channel, which: str, value: float | None) -> str:
    if value is None:
        return "–"
    ends = line(trace.curves, f"interval.{channel.letter}.{which}", 2)
    low, high = (value, value) if ends is None or not np.isfinite(ends).all() else map(float, ends)
    return estimate(value, (low, high))
