"""The figures at the head of the page: error before and after on held-out runs, with interval and floor."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.channels import AT_REVERSALS
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.thresholds import EXPLAINED, TURNED_BACK
from rig.report.figures.arrays import line
from rig.report.numbers import join
from rig.report.trace.channels import CHANNELS, Channel, held_out_with
from rig.report.trace.sizes import three


class Card(NamedTuple):
    """One channel: error before → after, as ratio to the floor, and what it was measured on."""

    label: str
    before: str
    after: str  # "" where nothing was added
    unit: str
    spread: str  # 95 % intervals of both
    ratio: str
    how: str
    main: bool  # where the most was left


def cards(trace: Trace) -> list[Card]:
    """A card for each channel that was measured; the one with most left first."""
    found = [c for c in CHANNELS if c.sensor in trace.ratios_before]
    most = max(found, key=lambda c: trace.ratios_before[c.sensor], default=None)
    return [_card(trace, c, c is most) for c in sorted(found, key=lambda c: c is not most)]


def changed(trace: Trace) -> bool:
    """Whether anything was added to the model that the errors could show."""
    return bool(trace.effects or trace.added_curves or trace.law) or trace.ratios_after != trace.ratios_before


def _card(trace: Trace, channel: Channel, main: bool) -> Card:
    alone = trace.verdict.status is Status.NOTHING or not changed(trace)
    before, after = channel.error(trace.before.pooled), channel.error(trace.after.pooled)
    floor = channel.floor(trace.before.pooled)
    ratios = trace.ratios_before[channel.sensor], trace.ratios_after.get(channel.sensor)
    ratio = f"{three(ratios[0])} × the floor"
    if not alone and ratios[1] is not None:
        ratio = f"{three(ratios[0])} → {three(ratios[1])} × the floor"
    back = _where_it_turns_back(trace, alone) if channel.sensor == "tau_m" else ""
    how = f"RMS of measured less model over {held_out_with(trace, channel.sensor)}"
    how += (
        f"; each run over the floor of its conditions, RMS {join(three(floor), channel.unit)}"
        if floor is not None
        else ""
    )
    how += f", {three(TURNED_BACK)} times that where the motor turns back" if back else ""
    spread = [_interval(trace, channel, which) for which in (("before",) if alone else ("before", "after"))]
    return Card(
        channel.name if channel.letter == "A" else f"{channel.name} error",
        three(before),
        "" if alone else three(after),
        channel.unit,
        " → ".join(spread) if all(spread) else "",
        ratio + back,
        f"{how}.",
        main,
    )


def _where_it_turns_back(trace: Trace, alone: bool) -> str:
    """The ratio of those few rows by themselves, where it is not small: all others drown them."""
    before, after = (r.get(AT_REVERSALS, 0.0) for r in (trace.ratios_before, trace.ratios_after))
    if before <= EXPLAINED:
        return ""
    return f"; where the motor turns back {three(before)}{'' if alone else f' → {three(after)}'} ×"


def _interval(trace: Trace, channel: Channel, which: str) -> str:
    ends = line(trace.curves, f"interval.{channel.letter}.{which}", 2)
    if ends is None or not np.isfinite(ends).all():
        return ""
    return " to ".join(three(float(v) * channel.scale) for v in ends)
