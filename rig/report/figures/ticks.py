"""Panels whose axes draw all their ticks with one that is moved along: to make a tick of matplotlib's costs ten times
what it costs to draw it, and a page has hundreds."""

from __future__ import annotations

from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import XAxis, YAxis
from matplotlib.ticker import NullLocator


class _OneTick:
    """Part of an axis: what it draws is what matplotlib's own would draw, in the same order."""

    def draw(self: Any, renderer: Any) -> None:
        """Grid line, mark and label of each tick, then the name of the axis and the offset of its numbers."""
        if not isinstance(self.get_minor_locator(), NullLocator):
            super().draw(renderer)  # type: ignore[misc]
            return
        if not self.get_visible():
            return
        renderer.open_group(__name__, gid=self.get_gid())
        boxes, (tick,) = [], self.get_major_ticks(1)
        at = self.get_majorticklocs()
        texts, offset = self.major.formatter.format_ticks(at), self.major.formatter.get_offset()
        for place, text in zip(at, texts, strict=True):
            if self._shows(place):
                tick.update_position(place)
                tick.label1.set_text(text)
                tick.draw(renderer)
                if offset:  # stands beside the labels
                    boxes.append(tick.label1.get_window_extent(renderer))
        self._update_label_position(renderer)
        self.label.draw(renderer)
        self._update_offset_text_position(boxes, [])
        self.offsetText.set_text(offset)
        self.offsetText.draw(renderer)
        renderer.close_group(__name__)
        self.stale = False

    def set_clip_path(self: Any, path: Any, transform: Any = None) -> None:
        """Of what is drawn: matplotlib's own makes a minor tick for it."""
        Artist.set_clip_path(self, path, transform)
        for tick in self.majorTicks:
            tick.set_clip_path(path, transform)

    def _shows(self: Any, place: float) -> bool:
        """Whether a tick lies within the view, or at its end but for rounding."""
        view = sorted(self.get_view_interval())
        low, high, here = self.get_transform().transform([*view, place])
        slack = 1e-10 * abs(high - low)
        return bool(min(low, high) - slack <= here <= max(low, high) + slack)


class _X(_OneTick, XAxis):
    pass


class _Y(_OneTick, YAxis):
    pass


class Panel(Axes):
    """Axes of such a kind. Everything else is matplotlib's."""

    def _init_axis(self) -> None:
        self.xaxis, self.yaxis = _X(self, clear=False), _Y(self, clear=False)
        for axis, sides in ((self.xaxis, ("bottom", "top")), (self.yaxis, ("left", "right"))):
            for side in sides:
                self.spines[side].register_axis(axis)
