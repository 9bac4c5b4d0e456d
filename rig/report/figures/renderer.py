"""matplotlib's renderer of SVG without what a page has no use for: the way through a canvas, groups by artist, words
measured anew for every figure, and paths of six decimals to be read and rounded."""

from __future__ import annotations

import io
import re
from functools import lru_cache
from typing import Any, Final

from matplotlib.backends.backend_svg import RendererSVG
from matplotlib.figure import Figure
from matplotlib.font_manager import FontProperties
from matplotlib.path import Path
from matplotlib.textpath import text_to_path

from rig.report.figures.paths import steps

CONTROL: Final = re.compile(r"[\x00-\x1f\x7f]")


def drawn(figure: Figure) -> str:
    """The figure as SVG in points that tells no date and no maker; its paths are steps but for those with curves."""
    width, height = 72.0 * figure.get_size_inches()
    text = io.StringIO()
    renderer = _Renderer(width, height, text, metadata={"Date": None, "Creator": None})
    figure.draw(renderer)
    renderer.finalize()
    return text.getvalue()


class _Renderer(RendererSVG):  # type: ignore[misc]  # no types come with the backends
    def open_group(self, s: str, gid: str | None = None) -> None:
        """Groups tell which artist drew what: on a page nobody asks."""

    def close_group(self, s: str) -> None:
        """None was opened."""

    def get_text_width_height_descent(self, s: str, prop: FontProperties, ismath: Any) -> tuple[float, float, float]:
        return super().get_text_width_height_descent(s, prop, ismath) if ismath else measured(s, prop)

    def draw_text(self, gc: Any, x: float, y: float, s: str, *rest: Any, **named: Any) -> None:
        """No font has a tab or a line feed, which the name of a folder may have."""
        super().draw_text(gc, x, y, CONTROL.sub(" ", s), *rest, **named)

    def _convert_path(
        self, path: Any, transform: Any = None, clip: Any = None, simplify: bool | None = None, sketch: Any = None
    ) -> str:
        if path.codes is not None and ((path.codes == Path.CURVE3) | (path.codes == Path.CURVE4)).any():
            text: str = super()._convert_path(path, transform, clip, simplify, sketch)
            return text
        view = (0.0, 0.0, self.width, self.height) if clip else None
        clean = path.cleaned(transform, remove_nans=True, clip=view, simplify=simplify, sketch=sketch)
        here = clean.codes != Path.STOP
        return steps(clean.vertices[here], clean.codes[here])


@lru_cache(4096)
def measured(text: str, font: FontProperties) -> tuple[float, float, float]:
    """Width, height and descent [pt]. To lay out a word costs more than all else that is done to draw it, and a page
    has each figure in two widths: most of its words and numbers stand in both.
    """
    plain = CONTROL.sub(" ", text)
    size: tuple[float, float, float] = text_to_path.get_text_width_height_descent(plain, font, False)
    return size
