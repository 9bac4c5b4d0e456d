"""A trace as one page: self-contained HTML, read without network or script, on paper as on a phone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.outcome.each_run import beside_the_numbers
from rig.analysis.tracing.outcome.free_told import free_told
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.outcome.told import listed, symbol
from rig.process.workers import each
from rig.report import page as run_page
from rig.report import words as run_words
from rig.report.figures import Drawing
from rig.report.shell import css, environment, plot
from rig.report.trace import tables, words
from rig.report.trace.campaign import Provenance
from rig.report.trace.cards import cards
from rig.report.trace.channels import CHANNELS
from rig.report.trace.figures import BEFORE_AFTER, WHERE, home
from rig.report.trace.sizes import said
from rig.report.words import Origin
from rig.runfile.manifest import write_atomic

HERE = Path(__file__).parent
SWEEP = "sweep.html"
QUIET = 1.15  # RMS over floor before: a channel with less is at its floor and gets no close-up of its own


def put(folder: Path, text: str) -> Path:
    """Write the rendered `text` as `folder`/report.html and return its path. The file is replaced whole or not at all;
    that of a sweep, which no verb makes again, is kept as SWEEP. Raises OSError."""
    page = folder / run_page.NAME
    if page.exists() and (folder / "result.json").exists() and not (folder / SWEEP).exists():
        page.replace(folder / SWEEP)
    write_atomic(page, text.encode(errors="replace"))
    return page


def render(trace: Trace, source: Provenance) -> str:
    """The page as text. The same arguments give the same text: no clock and no random number is asked."""
    origin = _origin(trace, source)
    curves = drawn(trace)
    lines, silent = tables.candidates(trace)
    heads, each = tables.each_run(trace)
    physical, orders = tables.moved(trace)
    plots = _plots((*WHERE, *BEFORE_AFTER), curves, origin.mark)
    meant = beside_the_numbers(trace.effects)  # said where the numbers stand
    view: dict[str, Any] = {
        "trace": trace,
        "origin": origin,
        "heading": words.heading(trace),
        "facts": source.facts(trace),
        "sentence": words.plainly(trace.verdict.sentence),
        "left_out": [words.plainly(s) for s in (*trace.cannot, *trace.notes) if s not in meant],
        "not_read": words.not_read(trace),
        "remainder": words.remainder(trace),
        "ruling": words.ruled(trace),
        "meaning": words.meant(trace),
        "sizes": words.sizes(trace.effects),
        "cards": cards(trace),
        "alone": trace.verdict.status is Status.NOTHING,
        "physical": [(*words.meaning(p), said(p)) for p in tables.physical(trace.baseline)],
        "orders": [(*words.meaning(p), said(p)) for p in tables.orders(trace.baseline)],
        "together": [listed([symbol(n) for n in g]) for g in trace.cannot_be_told_apart],
        "floors": tables.floors(trace),
        "told": home.told(curves),
        "lives": [words.place(c) for c in trace.lives_in],
        "candidates": lines,
        "silent": listed(silent),
        "added": words.added(trace),
        "own": words.of_each_run(trace),
        "found_first": listed([words.named(e.effect) for e in trace.effects if e.each_run]),
        "effects": [_effect(e.effect, e.parameters, e.share) for e in trace.effects],
        "moved": physical,
        "moved_orders": orders,
        "under_load": words.under_load(trace),
        "heads": heads,
        "each": each,
        "free": tables.free_runs(trace),
        "free_why": free_told(trace)["sentence"],
        "unmoved": words.unmoved(trace),
        "where": [plot for plot in plots[: len(WHERE)] if plot is not None],
        "before_after": [plot for plot in plots[len(WHERE) :] if plot is not None],
        "next": _next(trace),
        "runs": source.rows(trace),
        "software": source.software,
        "css": css(trace.campaign, origin.mark, HERE),
    }
    templates = environment(HERE)
    templates.filters["code"] = run_page.code
    return templates.get_template("page.html").render(view)


def drawn(trace: Trace) -> dict[str, Array]:
    """The curves of the trace with the errors of each run; close-ups of channels at their floor are left out."""
    curves = dict(trace.curves)
    for name, before in trace.before.per_run.items():
        after = trace.after.per_run.get(name, before)
        rows = [(c.error(before), c.error(after), c.floor(before)) for c in CHANNELS]
        curves[f"each_run.{name}"] = np.array([np.nan if v is None else v for row in rows for v in row])
    quiet = [c for c in CHANNELS if trace.ratios_before.get(c.sensor, 0.0) < QUIET]
    hidden = [f"close.{run}.{c.letter}." for c in quiet if c.letter != "A" for run in trace.held_out]
    hidden += [f"orders.{c.letter}." for c in quiet]
    if any(c.letter == "A" for c in quiet) and len(quiet) < len(trace.ratios_before):
        hidden += ["spectrum.", "angle.", "turn."]  # the kinematic error is at its floor, and something else is not
    return {name: values for name, values in curves.items() if not name.startswith(tuple(hidden))}


def _origin(trace: Trace, source: Provenance) -> Origin:
    """Of the campaign: simulated when any run is, else what its manifests agree on."""
    found = run_words.origin("sim" if trace.simulated else source.backend)
    if trace.simulated and len(source.backends) > 1:
        found = found._replace(sentence=run_words.IN_PART)
    return found._replace(run=f"Trace of {words.runs_read(trace)}, {found.word.lower()}")


def _plots(drawings: Sequence[Drawing], curves: Mapping[str, Array], mark: str) -> list[dict[str, Any] | None]:
    """None of a figure whose curves are absent."""
    return each(lambda drawing: plot(drawing, dict(curves), mark), drawings)


def _effect(name: str, parameters: Sequence[Any], share: float) -> dict[str, Any]:
    return {
        "name": words.named(name),
        "in_short": words.in_short(name),
        "share": f"{100 * min(max(share, 0.0), 1.0):.0f} %",
        "parameters": [(p.name, words.gloss(name, p.name, p.unit), said(p)) for p in parameters],
    }


def _next(trace: Trace) -> dict[str, Any] | None:
    run = trace.next_run
    if run is None:
        return None
    conditions = [": ".join((run_words.named(k)[0], _value(k, v))) for k, v in run.conditions.items()]
    return {
        "procedure": run_words.kind(run.procedure),
        "conditions": conditions,
        "because": words.plainly(run.because),
    }


def _value(key: str, value: float | bool | str) -> str:
    from rig.report.rows import measured

    return measured(key, value).value
