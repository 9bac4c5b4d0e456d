"""The tables of a trace: baseline, floor, suspects, what was added, held-out runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from rig.analysis.tracing.result import Candidate, Status, Trace
from rig.analysis.tracing.thresholds import EVIDENCE
from rig.model.effect import Parameter
from rig.model.effects import CATALOGUE
from rig.report.numbers import ABSENT, estimate, join, plain
from rig.report.trace import words
from rig.report.trace.channels import CHANNELS
from rig.report.words import humanise


class Moved(NamedTuple):
    """A parameter of the baseline before and after the effect was added."""

    symbol: str
    meaning: str
    before: str
    after: str
    shift: str
    sigmas: str
    far: bool  # the intervals do not meet


class Suspect(NamedTuple):
    """One effect of the library and what became of it."""

    name: str
    in_short: str
    evidence: str
    heldout: str
    ruling: str  # added, rival, dismissed
    why: str


def physical(found: Sequence[Parameter]) -> list[Parameter]:
    """Without the orders of the kinematic error."""
    return [p for p in found if not p.name.startswith(words.ORDER)]


def orders(found: Sequence[Parameter]) -> list[Parameter]:
    """The orders of the kinematic error alone."""
    return [p for p in found if p.name.startswith(words.ORDER)]


def said(p: Parameter) -> str:
    """Value with interval and unit."""
    return estimate(p.value, p.ci95, p.unit)


def moved(trace: Trace) -> list[Moved]:
    """Every parameter of the baseline that is there before and after."""
    after = {p.name: p for p in trace.baseline_after}
    return [_moved(p, after[p.name]) for p in trace.baseline if p.name in after]


def _moved(a: Parameter, b: Parameter) -> Moved:
    half = math.hypot(a.ci95[1] - a.ci95[0], b.ci95[1] - b.ci95[0]) / 2
    shift = b.value - a.value
    relative = join(f"{100 * shift / abs(a.value):+.1f}".replace("-", "−"), "%") if a.value else ABSENT
    times = abs(shift) / half if half > 0 else math.nan
    symbol, meaning = words.meaning(a)
    far = a.ci95[0] > b.ci95[1] or b.ci95[0] > a.ci95[1]
    return Moved(symbol, meaning, said(a), said(b), relative, f"{plain(times, 2)} ×", far)


def suspects(trace: Trace) -> tuple[list[Suspect], list[str]]:
    """Effects that explained anything, best first; and the names of those that explained nothing beyond chance."""
    shown = [_suspect(trace, c) for c in sorted(trace.candidates, key=lambda c: -c.evidence)]
    heard = {c.effect for c in trace.candidates}
    return shown, [words.named(n).lower() for n in CATALOGUE if n not in heard]


def _suspect(trace: Trace, c: Candidate) -> Suspect:
    v = trace.verdict
    in_model = {e.effect for e in trace.effects} | set(v.effects)
    ruling = "added" if c.effect in in_model else "rival" if c.effect in v.rivals else "dismissed"
    errors = [
        f"{channel.short} {join(plain(c.heldout_rms[channel.sensor] * channel.factor, 3), channel.unit)}"
        for channel in CHANNELS
        if channel.sensor in c.heldout_rms
    ]
    why = f"{_reason(trace, c, ruling)} {c.why.rstrip('.')}." if c.why else _reason(trace, c, ruling)
    return Suspect(
        words.named(c.effect),
        words.in_short(c.effect),
        plain(c.evidence, 3),
        "; ".join(errors) or ABSENT,
        ruling,
        why,
    )


def _reason(trace: Trace, c: Candidate, ruling: str) -> str:
    first = max(trace.candidates, key=lambda x: x.evidence)
    share = next((e.share for e in trace.effects if e.effect == c.effect), None)
    match ruling:
        case "added" if share is not None:
            return f"Removes {100 * min(share, 1.0):.0f} % of the excess it acts on in runs the fit did not see."
        case "added":
            return "Is in the model."
        case "rival":
            return "Explains these runs as well: cannot be dismissed with them."
    if c.evidence < EVIDENCE:
        return "No more than chance gives."
    if trace.verdict.status is Status.UNKNOWN:
        return "Does not hold on runs the fit did not see."
    if c.effect == first.effect:
        return "Best of all alone; beside the others it explains nothing more on runs the fit did not see."
    return (
        f"Alone it has {plain(100 * c.evidence / first.evidence, 2)} % of the evidence of {words.named(first.effect).lower()}; "
        "beside what was added nothing of it held on runs the fit did not see."
    )


def floors(trace: Trace) -> list[tuple[str, str, str]]:
    """(channel, RMS, how it was measured)."""
    by = {c.sensor: c for c in CHANNELS}
    out = []
    for f in trace.floors:
        channel = by.get(f.channel)
        value = join(plain(f.rms, 3), f.unit)
        if channel is not None and channel.factor != 1.0:
            value = f"{join(plain(f.rms * channel.factor, 3), channel.unit)} ({value})"
        out.append((f"{channel.name} {channel.short}" if channel else f.channel, value, humanise(f.how)))
    return out


def each_run(trace: Trace) -> tuple[list[str], list[list[str]]]:
    """Heads and rows of before, after, floor in each channel for each held-out run, all together last."""
    pairs = [(n, e, trace.after.per_run.get(n)) for n, e in trace.before.per_run.items()]
    pairs.append(("All held-out runs", trace.before.pooled, trace.after.pooled))
    shown = [c for c in CHANNELS if any(c.error(before) is not None for _, before, _ in pairs)]
    heads = [f"{c.short} {word}, {c.unit}" for c in shown for word in ("before", "after", "floor")]
    rows = []
    for name, before, after in pairs:
        cells = [name]
        for c in shown:
            values = (c.error(before), c.error(after) if after else None, c.floor(before))
            cells += [ABSENT if v is None else plain(v, 3) for v in values]
        rows.append(cells)
    return heads, rows
