"""A picture that grows with the rows: drawn once as a whole, then what every block changes."""

from __future__ import annotations

from abc import ABC, abstractmethod

from rig.live.view import colours
from rig.live.view.axes import Frame
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas, Pen


class Drawing(ABC):
    """One pane's picture. Blocks come in order of time; a block may follow another after a gap."""

    @abstractmethod
    def draw(self, t: float, canvas: Canvas) -> None:
        """All of it as it stands at run time `t` [s]: at the start, and on a canvas that knows nothing of it yet."""

    @abstractmethod
    def add(self, block: Block, canvas: Canvas) -> None:
        """The next rows, at least one."""

    def over(self, t: float, canvas: Canvas) -> None:
        """No row follows: what is only true of a motor that turns goes. Most pictures have nothing of the kind."""
        return


def draw_frame(path: str, t: float | None, frame: Frame, canvas: Canvas) -> None:
    """Axes, grid, numbers and titles of a plane."""
    canvas.lines(f"{path}/frame/grid", t, frame.grid(), Pen(colours.GRID, 1.0, -3.0))
    canvas.lines(f"{path}/frame/border", t, [frame.border()], Pen(colours.AXIS, 1.5, -2.0))
    where, numbers = frame.numbers()
    canvas.words(f"{path}/frame/numbers", t, where, numbers, colours.MUTED)
    where, titles = frame.titles()
    canvas.words(f"{path}/frame/titles", t, where, titles, colours.INK)
