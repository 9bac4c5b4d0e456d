"""What all pages have in common: the frame of the HTML, the style sheet, how templates are read, a plot drawn twice."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import jinja2
from markupsafe import Markup

from rig.analysis.findings.result import Array
from rig.report.figures import Drawing, Frame, svg
from rig.report.palette import DARK, LIGHT, variables

HERE = Path(__file__).parent
WIDE, NARROW = 760.0, 360.0  # px; each figure is drawn twice, so that its text is legible on a phone too


def environment(folder: Path) -> jinja2.Environment:
    """For the templates in `folder`, which extend the `base.html` that lies here."""
    loader = jinja2.FileSystemLoader([folder, HERE])
    return jinja2.Environment(
        loader=loader, autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )


def css(run: str, mark: str, folder: Path = HERE) -> Markup:
    """The style sheet, with what the `page.css` of a page of its own `folder` adds.

    `run` stands above every printed page, and so does `mark`, SIMULATED or nothing.
    """
    text = (HERE / "page.css").read_text(encoding="utf-8")
    for name, value in (
        ("{{LIGHT}}", variables(LIGHT)),
        ("{{DARK}}", variables(DARK)),
        ("{{RUN}}", css_string(run)),
        ("{{MARK}}", css_string(mark)),
    ):
        text = text.replace(name, value)
    return Markup(text if folder == HERE else f"{text}\n{(folder / 'page.css').read_text(encoding='utf-8')}")


def css_string(text: str) -> str:
    """`text` as a CSS string that cannot end early, nor close the style element: all but letters and digits escaped."""
    return '"' + "".join(c if c.isascii() and c.isalnum() else f"\\{ord(c):x} " for c in text) + '"'


def plot(drawing: Drawing, curves: dict[str, Array], mark: str) -> dict[str, Any] | None:
    """Anchor, title, note and both pictures of a figure, for a template; None where its curves are absent."""
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
