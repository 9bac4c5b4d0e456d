"""A canvas that keeps what was drawn, and rows to draw."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rig.live.view.about import About
from rig.live.view.block import LAYOUT, Block
from rig.live.view.nothing import Nothing

Array = np.ndarray[Any, Any]
ABOUT = About("u1", "kinematic-error", "kinematic_error", "G1", 50.0, True, False, 7000.0, 1000.0, "torque", "run", "")


class Kept(Nothing):
    """The newest of everything, by path."""

    def __init__(self) -> None:
        self.shown: dict[str, Any] = {}
        self.sent: list[tuple[str, Array, Array]] = []
        self.said: list[str] = []

    def curves(self, path: str, t: Array, values: Array) -> None:
        self.sent.append((path, t, values))

    def lines(self, path: str, t: float | None, lines: Sequence[Array], pen: Any) -> None:
        self.shown[path] = list(lines)

    def words(self, path: str, t: float | None, where: Array, words: Sequence[str], colour: int) -> None:
        self.shown[path] = list(words)

    def signs(self, path: str, where: Array, words: Sequence[str], colour: int) -> None:
        self.shown[path] = list(words)

    def bars(self, path: str, t: float | None, at: Array, values: Array, colour: int) -> None:
        self.shown[path] = (at, values)

    def turn(self, path: str, t: Array, angle: Array) -> None:
        self.shown[path] = (t, angle)

    def wires(self, path: str, t: float | None, wires: Sequence[Array], pen: Any) -> None:
        self.shown[path] = list(wires)

    def dot(self, path: str, t: float | None, where: Array, colour: int) -> None:
        self.shown[path] = where

    def event(self, path: str, t: float, level: str, text: str) -> None:
        self.said.append(f"{level} {text}")

    def page(self, path: str, t: float | None, markdown: str) -> None:
        self.shown[path] = markdown


def block(n: int, **columns: Any) -> Block:
    """n rows at 1 kHz; columns not named are not measured."""
    rows = np.zeros(n, LAYOUT)
    for name in LAYOUT.names or ():
        if LAYOUT[name].kind == "f":
            rows[name] = np.nan
    rows["t"] = np.arange(n) * 1e-3
    for name, values in columns.items():
        rows[name] = values
    return Block(rows)


def turning(turns: float, amplitude_arcsec: float, order: int = 2, n: int = 8000, way: int = 1) -> Block:
    """A gear of N = 50 with one line in its kinematic error, turned at an even speed."""
    theta_m = way * np.linspace(0.0, turns * 2 * np.pi, n)
    error = np.radians(amplitude_arcsec / 3600) * np.cos(order * theta_m)
    return block(n, theta_m=theta_m, theta_l=theta_m / 50 - error, tau_l=0.0, age=1e-4)
