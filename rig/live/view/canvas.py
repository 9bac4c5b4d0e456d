"""What can be drawn at all. The drawings know this, and not by whom it is shown; a test draws on a list."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rig.live.view.layout import Layout

Array = np.ndarray[Any, Any]
ALWAYS = None  # the time of what does not change


@dataclass(frozen=True)
class Pen:
    """How lines are drawn: 0xRRGGBB, width in pixels, what lies above what."""

    colour: int
    width: float = 1.5
    order: float = 0.0


@dataclass(frozen=True)
class Solid:
    """A cylinder along the rig's axis x, mm."""

    x: float  # of its middle
    length: float
    radius: float
    colour: int


class Canvas(ABC):
    """Paths are names like "/curves/angle"; `t` is run time [s], or ALWAYS."""

    @abstractmethod
    def arrange(self, layout: Layout) -> None:
        """Which panes there are, and where."""

    @abstractmethod
    def name_curves(self, path: str, names: Sequence[str], colours: Sequence[int]) -> None:
        """What the columns that `curves` sends to this path are called."""

    @abstractmethod
    def curves(self, path: str, t: Array, values: Array) -> None:
        """Curves over time: `t` shape (n,) s, `values` shape (n, k), a column per name; NaN is a gap."""

    @abstractmethod
    def lines(self, path: str, t: float | None, lines: Sequence[Array], pen: Pen) -> None:
        """Lines in a plane, each shape (n, 2) in units of the picture. They replace those drawn there before."""

    @abstractmethod
    def words(self, path: str, t: float | None, where: Array, words: Sequence[str], colour: int) -> None:
        """Words in a plane, at points of shape (n, 2)."""

    @abstractmethod
    def dot(self, path: str, t: float | None, where: Array, colour: int) -> None:
        """A dot in a plane, shape (1, 2); none any more where the shape is (0, 2)."""

    @abstractmethod
    def bars(self, path: str, t: float | None, at: Array, values: Array, colour: int) -> None:
        """Bars of height `values` (n,) at `at` (n,), equally spaced."""

    @abstractmethod
    def solid(self, path: str, solid: Solid) -> None:
        """A body that keeps its shape, in space; it moves with its path."""

    @abstractmethod
    def disc(self, path: str, half_axes: tuple[float, float, float], colour: int) -> None:
        """An ellipsoid around the origin of its path: half axes along x, y, z, mm."""

    @abstractmethod
    def wires(self, path: str, t: float | None, wires: Sequence[Array], pen: Pen) -> None:
        """Lines in space, each shape (n, 3), mm. The pen's width is mm."""

    @abstractmethod
    def signs(self, path: str, where: Array, words: Sequence[str], colour: int) -> None:
        """Words in space at points of shape (n, 3), mm; they do not change."""

    @abstractmethod
    def turn(self, path: str, t: Array, angle: Array) -> None:
        """Angle of a path about the rig's axis x: `t` shape (n,) s, `angle` shape (n,) rad."""

    @abstractmethod
    def event(self, path: str, t: float, level: str, text: str) -> None:
        """A line of the log. Levels: INFO, WARN, ERROR."""

    @abstractmethod
    def page(self, path: str, t: float | None, markdown: str) -> None:
        """A small text in Markdown."""
