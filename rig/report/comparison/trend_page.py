"""A trend as one self-contained page: each gear, procedure and operating point drawn over its runs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from markupsafe import Markup

from rig.catalogue.trend import Series, Trend
from rig.report import words as run_words
from rig.report.comparison.course import curves_of, drawing, note
from rig.report.figures import Frame, svg
from rig.report.shell import NARROW, WIDE, css, environment
from rig.runfile.manifest import write_atomic

HERE = Path(__file__).parent


def write(path: Path, found: Trend) -> Path:
    """Write the page to `path`, whole or not at all. Raises OSError."""
    write_atomic(path, render(found).encode(errors="replace"))
    return path


def render(found: Trend) -> str:
    """The page as text."""
    simulated = {s.simulated for s in found.series}
    backends = {spot.row.backend for s in found.series for spot in s.spots}
    origin = run_words.origin("sim" if True in simulated else next(iter(backends)) if len(backends) == 1 else None)
    view = {
        "origin": origin,
        "figure": found.figure,
        "left_out": found.left_out,
        "copies": found.copies,
        "series": [_series(k, s, origin.mark) for k, s in enumerate(found.series)],
        "note": note(found.series),
        "css": css("trend", origin.mark),
    }
    return environment(HERE).get_template("trend.html").render(view)


def _series(k: int, series: Series, mark: str) -> dict[str, Any]:
    shown, curves = drawing(series), curves_of(series)
    pictures = {
        name: Markup(svg(shown, curves, Frame(width, mark), prefix=f"t{k}-{name}-"))
        for name, width in (("wide", WIDE), ("narrow", NARROW))
    }
    sentence = series.sentence
    return {
        "title": series.title,
        "sentence": sentence[0].upper() + sentence[1:],
        "count": len(series.spots),
        **pictures,
    }
