"""All exhibits as one page: self-contained HTML, read without network or script, fit to be printed and hung up."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from markupsafe import Markup, escape

from rig.analysis.reproduction.claim import Ruling
from rig.analysis.reproduction.exhibit import Exhibit
from rig.report.figures import CATALOGUE, Drawing, Frame, svg
from rig.report.reproduction import spectrum_cpm, turn
from rig.report.reproduction.text import SAID, SIGN, TONE, cell, count, found, record
from rig.report.shell import css, environment
from rig.report.words import origin
from rig.runfile.manifest import write_atomic

HERE = Path(__file__).parent
NAME = "reproduction.html"
DATA = "reproduction.json"
WIDE, NARROW = 640.0, 360.0  # px; each figure is drawn twice, so that its text is legible on a phone too
OURS = (turn.TURNS, turn.COMPARED, spectrum_cpm.DRAWING)
SUBSCRIPT = re.compile(r"([A-Za-zθτψωΩ]\u0303?)_([a-z]{1,2})(?![a-z_])")  # θ̃_p, K_n, B_sp, tau_c: as symbols
DRAWINGS: Mapping[str, Drawing] = {d.name: d for d in (*CATALOGUE, *OURS)}


class About(NamedTuple):
    """What the page says besides the exhibits: below the title, of runs that do not count, the manifests' backend."""

    facts: Sequence[str]
    left_out: Sequence[str]
    backend: str | None


def write(folder: Path, exhibits: Sequence[Exhibit], about: About) -> Path:
    """Write reproduction.html and reproduction.json into `folder`; return the page's path. Raises OSError."""
    write_atomic(folder / DATA, json.dumps(record(exhibits), indent=1, ensure_ascii=False).encode() + b"\n")
    write_atomic(folder / NAME, render(exhibits, about).encode(errors="replace"))
    return folder / NAME


def render(exhibits: Sequence[Exhibit], about: About) -> str:
    """The page as text. The same arguments give the same text: no clock and no random number is asked."""
    where = origin(about.backend)
    rulings = count(exhibits)
    view = {
        "origin": where,
        "facts": about.facts,
        "left_out": about.left_out,
        "score": [(SIGN[r], TONE[r], rulings[r], words) for r, words in SCORE.items()],
        "exhibits": [_exhibit(e, where.mark) for e in exhibits],
        "css": css("hdrig reproduce", where.mark, HERE),
    }
    templates = environment(HERE)
    templates.filters["symbols"] = symbols
    return templates.get_template("page.html").render(view)


def symbols(text: str) -> Markup:
    """`text` escaped, what follows an underscore set below the line, and numbers held together with their ±."""
    held = str(escape(text)).replace(" ± ", "\u00a0±\u00a0").replace(" %", "\u00a0%")
    return Markup(SUBSCRIPT.sub(r"\1<sub>\2</sub>", held))


SCORE = {
    Ruling.HOLDS: "of the paper’s claims hold in these data",
    Ruling.FAILS: "do not",
    Ruling.OPEN: "cannot be told from them",
}


def _exhibit(e: Exhibit, mark: str) -> dict[str, Any]:
    return {
        "anchor": e.anchor,
        "number": e.number,
        "title": e.title,
        "paper": e.paper,
        "how": e.how,
        "missing": e.missing,
        "claims": [
            {
                "sign": SIGN[c.ruling], "tone": TONE[c.ruling], "said": SAID[c.ruling], "paper": c.paper,
                "found": found(c), "rule": c.rule,
            }
            for c in e.claims
        ],
        "columns": e.columns,
        "rows": [[cell(value) for value in row] for row in e.rows],
        **_pictures(e, mark),
    }  # fmt: skip


def _pictures(e: Exhibit, mark: str) -> dict[str, Markup]:
    """Wide and narrow; empty where there is nothing to draw."""
    drawing, pictures = DRAWINGS.get(e.drawing), {"wide": Markup(""), "narrow": Markup("")}
    if drawing is None:
        return pictures
    for name, width in (("wide", WIDE), ("narrow", NARROW)):
        text = svg(drawing, e.curves, Frame(width, mark), prefix=f"{e.anchor}-{name[0]}-")
        pictures[name] = Markup(text or "")  # ours, and escaped by the XML writer
    return pictures
