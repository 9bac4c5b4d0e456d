"""One run that is going on, on the viewer's canvas: sent while the viewer takes it, left out while it does not."""

from __future__ import annotations

from collections.abc import Callable

from rig.core.errors import HdrigError
from rig.live.view.about import About, about
from rig.live.view.block import Block, joined, of_ring
from rig.live.view.canvas import Canvas
from rig.live.view.feed import Feed
from rig.live.view.nothing import Nothing
from rig.live.view.picture import Picture

SHOWN = 500.0  # rows of a curve a second at most, two of each group: a screen has fewer columns
DRAWN = 2  # beats a picture: five a second; a viewer without a GPU falls behind with more
MOST = 4096  # rows a beat: a virtual clock makes more, and they are left out


class Scene:
    """Feed to picture to canvas; `step` is one beat, `renew` after the viewer came back empty."""

    def __init__(self, feed: Feed, open_canvas: Callable[[About], Canvas]) -> None:
        self.feed = feed
        self._open = open_canvas
        self._canvas: Canvas = Nothing()
        self._about: About | None = None
        self._picture: Picture | None = None
        self._blocks: list[Block] = []  # not yet in the pictures
        self._ended = False

    def step(self, heard: bool) -> None:
        """What came since the last beat. `heard`: the viewer takes what it is sent."""
        if self._picture is None:
            self._begin()
        if self._picture is None or self._about is None:
            return
        canvas = self._canvas if heard else Nothing()
        for event in self.feed.events():
            self._picture.event(event, canvas)
        rows = self.feed.rows(MOST)
        if len(rows):
            block = of_ring(rows, self._about.mode)
            self._picture.curves(block, canvas)
            self._blocks.append(block)
        ends = self.feed.over and not self._ended
        if self._blocks and (ends or len(self._blocks) >= DRAWN):
            self._picture.draw(joined(self._blocks), canvas)
            self._blocks.clear()
        if ends:
            self._ended = True
            self._picture.over(canvas)

    def renew(self) -> None:
        """The viewer knows nothing any more: a new stream, and all that stands at this moment."""
        if self._picture is not None and self._about is not None:
            self._canvas = self._open(self._about)
            self._picture.begin(self._canvas)

    def _begin(self) -> None:
        if not self.feed.ready:
            return
        try:
            self._about = about(self.feed.folder)
        except HdrigError:  # a manifest between two states: looked at again
            return
        every = max(int(2 * self._about.rate / SHOWN), 1)
        self._picture = Picture(self._about, every, None)
        self.renew()
