"""A canvas nobody looks at: the pictures go on while the viewer takes nothing, and nothing is kept for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rig.live.view.canvas import Canvas, Pen, Solid
from rig.live.view.layout import Layout

Array = np.ndarray[Any, Any]


class Nothing(Canvas):
    """Draws nothing."""

    def arrange(self, layout: Layout) -> None:
        pass

    def name_curves(self, path: str, names: Sequence[str], colours: Sequence[int]) -> None:
        pass

    def curves(self, path: str, t: Array, values: Array) -> None:
        pass

    def lines(self, path: str, t: float | None, lines: Sequence[Array], pen: Pen) -> None:
        pass

    def words(self, path: str, t: float | None, where: Array, words: Sequence[str], colour: int) -> None:
        pass

    def dot(self, path: str, t: float | None, where: Array, colour: int) -> None:
        pass

    def bars(self, path: str, t: float | None, at: Array, values: Array, colour: int) -> None:
        pass

    def solid(self, path: str, solid: Solid) -> None:
        pass

    def disc(self, path: str, half_axes: tuple[float, float, float], colour: int) -> None:
        pass

    def wires(self, path: str, t: float | None, wires: Sequence[Array], pen: Pen) -> None:
        pass

    def signs(self, path: str, where: Array, words: Sequence[str], colour: int) -> None:
        pass

    def turn(self, path: str, t: Array, angle: Array) -> None:
        pass

    def event(self, path: str, t: float, level: str, text: str) -> None:
        pass

    def page(self, path: str, t: float | None, markdown: str) -> None:
        pass
