"""Everything that is drawn of one run."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rig.core.numbers import number
from rig.live.view.about import About
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas
from rig.live.view.curves import GROUPS, TICK, Curves, More, everything
from rig.live.view.drawing import Drawing
from rig.live.view.folded import Folded
from rig.live.view.layout import FOLDED, LOSS, ORDERS, STRIBECK, WIND_UP, Group, Kind, Pane, layout_for
from rig.live.view.layout import TICK as TICK_PANE
from rig.live.view.orders import Orders
from rig.live.view.space import Space
from rig.live.view.trail import STRIBECK as STRIBECK_PLANE
from rig.live.view.trail import WIND_UP as WIND_UP_PLANE
from rig.live.view.trail import Trail, loss

LEVELS = {"trip": "ERROR", "operator": "WARN"}


class Picture:
    """Begun once; then rows, in order, and events."""

    def __init__(
        self,
        about: About,
        every: int,
        span: tuple[float, float] | None,
        measured: Callable[[str], bool] = everything,
        more: tuple[More, ...] = (),
    ) -> None:
        """`every`: rows of which two are drawn as curves; `span` [s of the run] of the curves, None: the last ones.

        `measured` as in `Curves`; `more`: groups of curves beside those everybody has.
        """
        self._about = about
        panes_more = [
            Pane(Kind.TIME, one.path, f"Other channels [{one.unit}]", legend=True)
            for one in more
            if any(measured(one.path + curve.name) for curve in one.curves)
        ]
        self._layout = layout_for(about.procedure, about.title, span, absent(about, measured), panes_more)
        self._t = 0.0
        self._curves = Curves(about, every, measured, more)
        self._drawings = [*_planes(about, self._layout.root), Space(about)]

    def begin(self, canvas: Canvas) -> None:
        """Panes, names, axes, and what was drawn so far, on a canvas that knows nothing of it."""
        canvas.arrange(self._layout)
        canvas.page("/page", None, page(self._about))
        self._curves.begin(canvas)
        for drawing in self._drawings:
            drawing.draw(self._t, canvas)

    def curves(self, block: Block, canvas: Canvas) -> None:
        """The next rows, as curves over time."""
        self._curves.add(block, canvas)

    def draw(self, block: Block, canvas: Canvas) -> None:
        """The same rows, in every other picture; in blocks as long as a picture may stand still."""
        if len(block):
            self._t = float(block.t[-1])
            for drawing in self._drawings:
                drawing.add(block, canvas)

    def over(self, canvas: Canvas) -> None:
        """No row follows."""
        for drawing in self._drawings:
            drawing.over(self._t, canvas)

    def event(self, event: dict[str, Any], canvas: Canvas) -> None:
        """A line of events.jsonl."""
        t, kind, text = event.get("t"), str(event.get("kind", "")), str(event.get("text", ""))
        at = number(t, 0.0)
        canvas.event("/events", at, LEVELS.get(kind, "INFO"), f"{kind}: {text}")


def absent(about: About, measured: Callable[[str], bool]) -> set[str]:
    """Paths of panes that would stay empty."""
    without = {path for path, group in GROUPS.items() if not any(measured(path + curve.name) for curve in group)}
    error, shaft = "/curves/error" in without, "/curves/shaft" in without
    lacking = {FOLDED: error, ORDERS: error, WIND_UP: error or shaft, LOSS: error or shaft or not about.stiffness}
    lacking[TICK_PANE] = not about.rate and not measured(TICK)
    return without | {pane.path for pane, empty in lacking.items() if empty}


def _planes(about: About, group: Group) -> list[Drawing]:
    """The drawings whose panes are somewhere in the layout."""
    known: dict[Pane, Callable[[], Drawing]] = {
        FOLDED: lambda: Folded(about.ratio, about.banner),
        ORDERS: lambda: Orders(about.ratio),
        WIND_UP: lambda: Trail(WIND_UP_PLANE, about.ratio, about.banner),
        LOSS: lambda: Trail(loss(about.stiffness), about.ratio, about.banner),
        STRIBECK: lambda: Trail(STRIBECK_PLANE, about.ratio, about.banner),
    }
    return [known[pane]() for pane in panes(group) if pane in known]


def panes(group: Group) -> list[Pane]:
    """Every pane of a layout, in order."""
    return [pane for part in group.parts for pane in (panes(part) if isinstance(part, Group) else [part])]


def page(about: About) -> str:
    """What this is, in a few lines of Markdown."""
    head = f"## {about.banner}\n" if about.banner else ""
    rate = f", {about.rate:g} Hz" if about.rate else ""
    when = f"{_plain(about.started[:19].replace('T', ' '))} UTC · " if about.started else ""
    rows = [
        f"{head}**{_plain(about.title)}** · {_plain(about.gear)}, N = {about.ratio:g}{rate}",
        f"{when}{_plain(about.folder)}",
        "Curves keep every peak; planes show means of 1° or of 10 to 50 ms. Figures with intervals: in the report.",
    ]
    return "\n\n".join(rows)


def _plain(text: str) -> str:
    """Words of a manifest, which may be anything, with nothing in them that Markdown acts upon."""
    return "".join(c if c.isalnum() or c in " .,:+-_/()" else " " for c in text)[:80]
