"""One run and its result as one page: self-contained HTML, read without network or script, on paper as on a phone."""

from __future__ import annotations

import gc
import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
from markupsafe import Markup, escape

from rig.analysis.result import Array, Result
from rig.core.numbers import number as number_of
from rig.report import rows, words
from rig.report.cards import cards
from rig.report.figures import CATALOGUE, Drawing, Frame, styled, svg
from rig.report.history import told
from rig.report.numbers import duration
from rig.report.palette import DARK, LIGHT, variables
from rig.report.provenance import provenance
from rig.report.tables import Table, number, tables
from rig.runfile.manifest import contents, write_atomic

HERE = Path(__file__).parent
NAME = "report.html"
WIDE, NARROW = 760.0, 360.0  # px; each figure is drawn twice, so that its text is legible on a phone too


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
        "css": _css(run, origin.mark),
    }
    view["contents"] = _contents(view)
    loader = jinja2.FileSystemLoader(HERE)
    environment = jinja2.Environment(
        loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters["code"] = code
    return environment.get_template("page.html").render(view)


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
        return [p for d in CATALOGUE if (p := _plot(d, curves, mark)) is not None]


def _plot(drawing: Drawing, curves: dict[str, Array], mark: str) -> dict[str, Any] | None:
    with uncollected():
        wide = svg(drawing, curves, Frame(WIDE, mark), prefix=f"{drawing.name}-w-")
        narrow = wide and svg(drawing, curves, Frame(NARROW, mark), prefix=f"{drawing.name}-n-")
    if wide is None or narrow is None:
        return None
    title, note = drawing.named(curves) if drawing.named else (drawing.title, drawing.note)
    pictures = {"wide": Markup(wide), "narrow": Markup(narrow)}  # ours, and escaped by the XML writer
    return {"anchor": drawing.name, "title": title, "note": note, "full": drawing.full, **pictures}


@contextmanager
def uncollected() -> Iterator[None]:
    """Python looks for no garbage meanwhile. A figure is ten thousand small objects that all live until it is written:
    to look through them again and again was a sixth of the time of a page.
    """
    usual = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if usual:
            gc.enable()


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
    if result.rejected:
        return f"{were}: the run is rejected and its figures do not count."
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
        ("cannot", "What this run cannot tell", view["cannot"]),
        ("events", "Events", view["events"]),
        ("provenance", "Provenance", True),
    )
    return [(anchor, name) for anchor, name, there in sections if there]


def _css(run: str, mark: str) -> Markup:
    text = (HERE / "page.css").read_text(encoding="utf-8")
    for name, value in (
        ("{{LIGHT}}", variables(LIGHT)),
        ("{{DARK}}", variables(DARK)),
        ("{{RUN}}", css_string(run)),
        ("{{MARK}}", css_string(mark)),
    ):
        text = text.replace(name, value)
    return Markup(text)


def code(text: str) -> Markup:
    """`text` escaped, with what stands between backticks set in the typewriter face."""
    return Markup(re.sub(r"`([^`]+)`", r'<code class="code">\1</code>', str(escape(text))))


def sentence_of(text: str) -> str:
    """`text` with a capital and a full stop; "" stays ""."""
    return f"{text[:1].upper()}{text[1:]}." if text else ""


def css_string(text: str) -> str:
    """`text` as a CSS string that cannot end early, nor close the style element: all but letters and digits escaped."""
    return '"' + "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text) + '"'
