"""One run and its result as one page: self-contained HTML, read without network or script, on paper as on a phone."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup, escape

from rig.analysis.findings.result import Array, Result
from rig.core.numbers import number as number_of
from rig.report import rows, words
from rig.report.cards import cards
from rig.report.figures import CATALOGUE, styled
from rig.report.history import told
from rig.report.numbers import duration
from rig.report.provenance import provenance
from rig.report.shell import HERE, css, environment, plot
from rig.report.tables import Table, number, tables
from rig.runfile.manifest import contents, write_atomic

NAME = "report.html"


def write(
    folder: Path,
    manifest: dict[str, Any],
    timing: object,
    events: object,
    result: Result,
    *,
    run: Path | None = None,
) -> Path:
    """Write `folder`/report.html and return its path. The file is replaced whole or not at all. Raises OSError.

    `bench.toml` is read from the run folder, where it lies there; `run` is that folder when the report goes elsewhere.
    """
    source = folder if run is None else run
    text = render(manifest, timing, events, result, source.name, bench(source))
    write_atomic(folder / NAME, text.encode(errors="replace"))
    return folder / NAME


def bench(folder: Path) -> dict[str, Any]:
    """The resolved bench of the run; empty where there is none that can be read."""
    try:
        return tomllib.loads(contents(folder / "bench.toml").decode())
    except (OSError, ValueError, RecursionError):  # also what is no text file
        return {}


def render(
    manifest: Mapping[str, Any],
    timing: object,
    events: object,
    result: Result,
    run: str,
    numbers: Mapping[str, Any],
) -> str:
    """The page as text. The same arguments give the same text: no clock and no random number is asked."""
    manifest, timing, events = rows.cut(dict(manifest)), rows.cut(timing), rows.cut(events)
    origin = words.origin(manifest.get("backend"))
    gear = rows.table(manifest.get("gear"))
    timing_rows, timing_said = rows.timing(timing)
    curves = with_numbers(result)
    view = {
        "run": run,
        "origin": origin,
        "heading": words.heading(result.procedure, manifest),
        "serial": rows.show(gear["serial"]) if gear.get("serial") else "",
        "facts": _facts(manifest, gear, result.curves, run),
        "ruling": words.RULINGS[result.verdict],
        "sentence": result.sentence,
        "judged": sentence_of(told(result)),
        "ending": words.ended_early(manifest),
        "main": cards(result.estimates),
        "checks": [{"passed": c.passed, "sentence": c.sentence} for c in result.checks],
        "checks_said": _checks_said(result),
        "plots": _plots(curves, origin.mark),
        "tables": tables(result.tables),
        "timing": timing_rows,
        "timing_said": timing_said,
        "conditions": rows.conditions(manifest),
        "declared": rows.declared(manifest),
        "cannot": result.cannot,
        "events": rows.events(events),
        "provenance": provenance(manifest, run),
        "files": rows.files(manifest),
        "bench": list(rows.bench_numbers(numbers)),
        "css": css(run, origin.mark),
    }
    view["contents"] = _contents(view)
    templates = environment(HERE)
    templates.filters["code"] = code
    return templates.get_template("page.html").render(view)


def with_numbers(result: Result) -> dict[str, Array]:
    """The curves, and the numbers that are drawn into them: a drawing and its text must not say different things."""
    numbers: dict[str, Array] = {}
    for e in result.estimates:
        match e.name:
            case "kinematic_error_peak_to_peak":
                numbers["ke.peak_to_peak"] = np.array([e.value, *e.ci95])
            case "fourier_terms":
                numbers["mse.chosen"] = np.array([e.value])
    rows = result.tables.get("coefficients", [])
    for curve, key in (("orders.low", "C_lo"), ("orders.high", "C_hi")):
        if rows and all(key in row for row in rows):
            numbers[curve] = np.array([number(row, key) for row in rows])
    return numbers | result.curves


def _plots(curves: dict[str, Array], mark: str) -> list[dict[str, Any]]:
    with styled():
        return [p for d in CATALOGUE if (p := plot(d, curves, mark)) is not None]


def _facts(manifest: Mapping[str, Any], gear: Mapping[str, Any], curves: dict[str, Array], run: str) -> list[str]:
    found = [f"Gear {rows.show(gear['serial'])}"] if gear.get("serial") else []
    found += [f"ratio {rows.show(gear['ratio'])}"] if gear.get("ratio") else []
    found += [rows.utc(manifest["started_utc"])] if manifest.get("started_utc") else []
    length = manifest.get("duration")
    t = np.asarray(curves.get("time.t", ()), dtype=np.float64)
    if math.isfinite(number_of(length)):
        found.append(duration(number_of(length)))
    elif t.size > 1 and np.isfinite(t).any():
        found.append(duration(float(np.nanmax(t) - np.nanmin(t))))
    return [*found, run]


def _checks_said(result: Result) -> str:
    failed = sum(not c.passed for c in result.checks)
    total = len(result.checks)
    if failed == 0:
        return f"All {total} conditions were met." if total > 1 else "The condition was met."
    were = f"{failed} of {total} conditions {'was' if failed == 1 else 'were'} not met"
    if total == 1:
        were = "The condition was not met"
    if result.rejected:
        return f"{were}: the run is rejected and its figures do not count."
    if all(c.passed or c.name.startswith("limit_") for c in result.checks):
        return f"{were}, {'a limit' if failed == 1 else 'limits'} alone: no reason to doubt the figures."
    return f"{were}: read the figures with that in mind."


def _contents(view: Mapping[str, Any]) -> list[tuple[str, str]]:
    plots = [(p["anchor"], p["title"]) for p in view["plots"]]
    found: list[Table] = view["tables"]
    sections = (
        ("verdict", "Verdict", True),
        ("figures", "Main figures", view["main"]),
        ("checks", "Checks", view["checks"]),
        *((anchor, name, True) for anchor, name in plots),
        *((t.anchor, t.title, True) for t in found),
        ("timing", "Loop timing", view["timing"] or view["timing_said"]),
        ("conditions", "Conditions", view["conditions"] or view["declared"]),
        ("cannot", "What this run cannot tell, and notes", view["cannot"]),
        ("events", "Events", view["events"]),
        ("provenance", "Provenance", True),
    )
    return [(anchor, name) for anchor, name, there in sections if there]


def code(text: str) -> Markup:
    """`text` escaped, with what stands between backticks set in the typewriter face."""
    return Markup(re.sub(r"`([^`]+)`", r'<code class="code">\1</code>', str(escape(text))))


def sentence_of(text: str) -> str:
    """`text` with a capital and a full stop; "" stays ""."""
    return f"{text[:1].upper()}{text[1:]}." if text else ""
