"""A comparison as one self-contained page: figures side by side, what changed, and the waveforms over one another."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from markupsafe import Markup

from rig.analysis.analyse import analyse
from rig.catalogue.compare import Comparison, Difference, Mark
from rig.catalogue.figures import Figure
from rig.catalogue.row import Row
from rig.catalogue.sameness import point, words
from rig.catalogue.scatter import SHARE
from rig.core.errors import HdrigError
from rig.report import rows
from rig.report import words as run_words
from rig.report.comparison.waveforms import drawing, joined
from rig.report.figures import Frame, svg
from rig.report.figures.canvas import Curves
from rig.report.numbers import ABSENT, estimate, plain
from rig.report.shell import NARROW, WIDE, css, environment
from rig.runfile.manifest import write_atomic
from rig.runfile.run import Run

HERE = Path(__file__).parent
MARKS = {Mark.CHANGED: "changed", Mark.WITHIN: "within", Mark.UNKNOWN: "cannot be judged", Mark.NONE: ""}


def write(path: Path, found: Comparison) -> Path:
    """Write the page to `path`, whole or not at all. Raises OSError."""
    write_atomic(path, render(found).encode(errors="replace"))
    return path


def render(found: Comparison) -> str:
    """The page as text. The waveforms are analysed from the samples here, which takes seconds a run."""
    origin = run_words.origin(_backend(found.rows))
    curves, cannot = [], []
    for row in found.rows:
        one, why = _curves(row.path)
        curves.append(one)
        cannot += [f"Waveform of {row.path.name}: {why}"] if why else []
    shown = drawing(range(1, len(found.rows) + 1))
    view = {
        "origin": origin,
        "runs": [_run(row) for row in found.rows],
        "remarks": [*found.remarks, *cannot],
        "plot": _plot(joined(curves), shown, origin.mark),
        "note": shown.note,
        "lines": [_line(line.label, line.unit, line.values, line.differences) for line in found.lines],
        "share": f"{100 * SHARE:g}",
        "css": css("comparison", origin.mark, HERE),
    }
    return environment(HERE).get_template("page.html").render(view)


def _backend(runs: tuple[Row, ...]) -> str | None:
    """Simulated as soon as one is; else theirs, if they share it."""
    backends = {row.backend for row in runs}
    return "sim" if "sim" in backends else next(iter(backends)) if len(backends) == 1 else None


def _curves(folder: Path) -> tuple[Curves | None, str]:
    """What the analysis draws; or why it cannot."""
    try:
        found = analyse(Run.open(folder), None)
        return (None, found.sentence) if found.broke_off else (found.curves, "")
    except HdrigError as error:
        return None, str(error)


def _plot(curves: Curves, shown: Any, mark: str) -> dict[str, Markup] | None:
    pictures = {
        name: svg(shown, curves, Frame(width, mark), prefix=f"w-{name}-")
        for name, width in (("wide", WIDE), ("narrow", NARROW))
    }
    found = {name: Markup(text) for name, text in pictures.items() if text is not None}  # ours, escaped by its writer
    return found if len(found) == 2 else None


def _run(row: Row) -> dict[str, str]:
    return {
        "name": row.path.name,
        "what": words(point(row)),
        "gear": row.gear or ABSENT,
        "started": rows.utc(row.started_utc) if row.started_utc else ABSENT,
        "assembly": str(row.conditions.get("assembly", ABSENT)),
        "ended": f"{row.status} {row.ruling}".strip(),
        "origin": run_words.origin(row.backend or None).word,
    }


def _line(
    label: str, unit: str, values: tuple[Figure | None, ...], differences: tuple[Difference | None, ...]
) -> dict[str, Any]:
    cells = []
    for value, d in zip(values, differences, strict=True):
        cells.append(
            {
                "value": "not in this run" if value is None else estimate(value.value, (value.low, value.high), unit),
                "void": value is not None and value.rejected,
                "difference": "" if d is None or d.value == 0 else _signed(d, unit),
                "mark": "" if d is None else MARKS[d.mark],
                "changed": d is not None and d.mark is Mark.CHANGED,
                "limit": "" if d is None or d.mark is Mark.NONE else plain(d.limit, 2),
                "how": "" if d is None else d.how,
            }
        )
    return {"label": label, "cells": cells}


def _signed(d: Difference, unit: str) -> str:
    return ("+" if d.value > 0 else "") + estimate(d.value, (d.low, d.high), unit)
