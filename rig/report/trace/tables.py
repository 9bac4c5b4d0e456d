"""The tables of a trace: baseline, floor, candidates, what was added, held-out runs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from rig.analysis.tracing.answer import Candidate, Status
from rig.analysis.tracing.outcome.free import together
from rig.analysis.tracing.outcome.free_told import over_floor
from rig.analysis.tracing.outcome.honest import ORDER
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.thresholds import EVIDENCE
from rig.model.effect import Parameter
from rig.model.effects import CATALOGUE
from rig.report.numbers import ABSENT, estimate, join, plain
from rig.report.trace import words
from rig.report.trace.channels import CHANNELS
from rig.report.trace.sizes import said, three
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


class CandidateRow(NamedTuple):
    """One effect of the library and what became of it."""

    name: str
    in_short: str
    evidence: str
    heldout: list[str]
    ruling: str  # added, rival, dismissed
    why: str


def physical(found: Sequence[Parameter]) -> list[Parameter]:
    """Without the orders of the kinematic error."""
    return [p for p in found if not p.name.startswith(ORDER)]


def orders(found: Sequence[Parameter]) -> list[Parameter]:
    """The orders of the kinematic error alone."""
    return [p for p in found if p.name.startswith(ORDER)]


def moved(trace: Trace) -> tuple[list[Moved], list[Moved]]:
    """Parameters of the baseline that are there before and after: physical ones, and orders."""
    after = {p.name: p for p in trace.baseline_after}
    halves = (physical(trace.baseline), orders(trace.baseline))
    first, second = ([_moved(p, after[p.name]) for p in half if p.name in after] for half in halves)
    return first, second


def _moved(a: Parameter, b: Parameter) -> Moved:
    half = math.hypot(a.ci95[1] - a.ci95[0], b.ci95[1] - b.ci95[0]) / 2
    shift = b.value - a.value
    known = abs(a.value) > (a.ci95[1] - a.ci95[0]) / 2  # else a percentage of it says nothing
    relative = 100 * shift / abs(a.value) if known else math.nan
    sign = "+" if relative >= 0.05 else "−" if relative <= -0.05 else ""
    percent = join(f"{sign}{abs(relative):.1f}", "%") if math.isfinite(relative) else ABSENT
    times = f"{abs(shift) / half:.1f} ×" if half > 0 else ABSENT
    symbol, meaning = words.meaning(a)
    far = a.ci95[0] > b.ci95[1] or b.ci95[0] > a.ci95[1]
    return Moved(symbol, meaning, said(a), said(b), percent, times, far)


def candidates(trace: Trace) -> tuple[list[CandidateRow], list[str]]:
    """Effects that explained anything, best first; and the names of those that explained nothing beyond chance."""
    shown = [_row(trace, c) for c in sorted(trace.candidates, key=lambda c: -c.evidence)]
    tried = {c.effect for c in trace.candidates}
    return shown, [words.named(n).lower() for n in CATALOGUE if n not in tried]


def _row(trace: Trace, c: Candidate) -> CandidateRow:
    v = trace.verdict
    in_model = {e.effect for e in trace.effects} | set(v.effects)
    equals = {*v.rivals, *v.effects} if v.status is Status.AMBIGUOUS else set(v.rivals)
    ruling = "rival" if c.effect in equals else "added" if c.effect in in_model else "dismissed"
    errors = [
        f"{channel.short} {join(three(c.heldout_rms[channel.sensor] * channel.factor), channel.unit)}"
        for channel in CHANNELS
        if channel.sensor in c.heldout_rms
    ]
    why = " ".join(
        f"{part.rstrip('.')}." for part in (_ruled(trace, c, ruling), _capital(words.plainly(c.why))) if part
    )
    return CandidateRow(
        words.named(c.effect), words.in_short(c.effect), plain(c.evidence, 3), errors, ruling, why or ABSENT
    )


def _ruled(trace: Trace, c: Candidate, ruling: str) -> str:
    """Why it was added, could not be dismissed, or was; in words the trace itself does not give."""
    share = next((e.share for e in trace.effects if e.effect == c.effect), None)
    match ruling:
        case "added" if share is not None and len(trace.effects) > 1:
            return (
                f"Beside the other it removes {100 * min(share, 1.0):.0f} % of the excess it acts on in held-out runs"
            )
        case "rival":
            return "Explains these runs as well: it cannot be dismissed with them"
        case "dismissed" if c.evidence < EVIDENCE:
            return "No more than chance gives"
    return ""


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def floors(trace: Trace) -> list[tuple[str, str, str]]:
    """(channel, RMS and what is known of it, how it was measured)."""
    by = {c.sensor: c for c in CHANNELS}
    out = []
    for f in trace.floors:
        channel = by.get(f.channel)
        factor, unit = (channel.factor, channel.unit) if channel is not None else (1.0, f.unit)
        value = join(three(f.rms * factor), unit)
        if f.ci95 is not None:
            value = estimate(f.rms * factor, (f.ci95[0] * factor, f.ci95[1] * factor), unit)
        out.append((f"{channel.name} {channel.short}" if channel else f.channel, value, humanise(f.how)))
    return out


class Cell(NamedTuple):
    """One channel of one run."""

    before: str
    after: str
    floor: str


def each_run(trace: Trace) -> tuple[list[str], list[tuple[str, list[Cell]]]]:
    """Channels shown, and for each held-out run, all together last, the error before, after and the floor."""
    pairs = [(n, e, trace.after.per_run.get(n, e)) for n, e in trace.before.per_run.items()]
    pairs.append(("All held-out runs", trace.before.pooled, trace.after.pooled))
    shown = [c for c in CHANNELS if any(c.error(before) is not None for _, before, _ in pairs)]
    heads = [f"{c.name} {c.short}, {c.unit}" for c in shown]
    rows = [
        (name, [Cell(three(c.error(before)), three(c.error(after)), three(c.floor(before))) for c in shown])
        for name, before, after in pairs
    ]
    return heads, rows


class FreeRun(NamedTuple):
    """A run by free simulation: RMS of the kinematic error in arcsec, floor of the equations, what is after over that,
    and what the rest of the shaft torque makes by itself."""

    name: str
    before: str
    after: str
    floor: str
    times: str
    by_load: str


def free_runs(trace: Trace) -> list[FreeRun]:
    """The held-out runs that were simulated, what they come to together last where there are two; [] where none was."""
    pairs = [(n, e, trace.after.per_run.get(n, e)) for n, e in trace.before.per_run.items()]
    pairs = [pair for pair in pairs if pair[1].free_kinematic_error_rms_arcsec is not None]
    if len(pairs) > 1:
        floor = together(b.floor_kinematic_error_arcsec for _, _, b in pairs)
        pooled = replace(trace.after.pooled, floor_kinematic_error_arcsec=floor)
        pairs.append(("Together", trace.before.pooled, pooled))
    return [
        FreeRun(
            name,
            three(a.free_kinematic_error_rms_arcsec),
            three(b.free_kinematic_error_rms_arcsec),
            three(b.floor_kinematic_error_arcsec),
            three(over_floor(b)),
            three(b.free_by_load_rest_rms_arcsec),
        )
        for name, a, b in pairs
    ]
