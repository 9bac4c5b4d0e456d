"""One quantity against another as it goes: torque against wind-up, torque against speed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rig.core.units import ARCMIN, RPM
from rig.live.view import colours
from rig.live.view.axes import WIDTH, Axis, Frame
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas, Pen
from rig.live.view.curves import speed
from rig.live.view.drawing import Drawing, draw_frame
from rig.model.transmission_error import transmission_error

Array = np.ndarray[Any, Any]

PIECE = 300  # points of a piece: what is sealed is sent once
PIECES = 24  # the trail's length: older ones give their place to new ones
APART = 1 / 300  # of an axis: nearer points are one on any screen
BACK = 0.05  # of the axis that x goes back before it counts as another way: noise and stick-slip turn all the time


@dataclass(frozen=True)
class Plane:
    """What is drawn against what: names, units, and how they come from rows and ratio N; `mean` s are averaged."""

    path: str
    x: Axis
    y: Axis
    of: Callable[[Block, float], tuple[Array, Array]]
    mean: float


WIND_UP = Plane(
    "/wind_up",
    Axis("wind-up θ_m/N − θ_l", "arcmin", -1.0, 1.0),
    Axis("shaft torque τ_l", "N·m", -5.0, 5.0),
    lambda b, n: (twist(b, n) / ARCMIN, b["tau_l"]),
    0.01,
)
STRIBECK = Plane(
    "/stribeck",
    Axis("motor speed ω_m", "rpm", -10.0, 10.0),
    Axis("motor torque given", "N·m", -0.1, 0.1),
    lambda b, n: (speed(b) / RPM, torque(b)),
    0.05,
)


def loss(stiffness: float) -> Plane:
    """What of the torque is no straight spring of `stiffness` N·m/rad: hysteresis, and stiffness that is not constant.

    Beside the whole torque a loop of a few per cent is a line.
    """
    return Plane(
        "/loss",
        Axis("wind-up θ_m/N − θ_l", "arcmin", -1.0, 1.0),
        Axis(f"τ_l less {stiffness:g} N·m/rad of wind-up", "N·m", -0.5, 0.5),
        lambda b, n: (twist(b, n) / ARCMIN, b["tau_l"] - stiffness * twist(b, n)),
        0.05,
    )


@dataclass
class Piece:
    """Part of the trail that ran one way."""

    way: int
    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)

    def turned(self, back: float) -> int | None:
        """Where x turned round, once it has come `back` by so much; None while it has not."""
        furthest = max(range(len(self.x)), key=lambda i: self.way * self.x[i])
        return furthest if self.way * (self.x[furthest] - self.x[-1]) > back else None

    def split(self, at: int, way: int) -> Piece:
        """This piece ends at point `at`; what came after is the beginning of the next."""
        later = Piece(way, self.x[at:], self.y[at:])
        del self.x[at + 1 :], self.y[at + 1 :]
        return later


class Trail(Drawing):
    """The plane's points in the order they came, coloured by which way x went."""

    def __init__(self, plane: Plane, ratio: float, banner: str) -> None:
        self._plane, self._ratio, self._banner = plane, ratio, banner
        self._frame = Frame(plane.x, plane.y)
        self._pieces: deque[tuple[int, Piece]] = deque(maxlen=PIECES)
        self._count = 0

    def draw(self, t: float, canvas: Canvas) -> None:
        """Axes and the whole trail as they stand at run time `t` s."""
        draw_frame(self._plane.path, t, self._frame, canvas)
        for number, piece in self._pieces:
            self._draw(t, number, piece, canvas)
        if self._banner:
            where = np.array([[WIDTH - 16.0, -10.0]], dtype=np.float32)
            canvas.words(f"{self._plane.path}/banner", None, where, [self._banner], colours.MARK)

    def add(self, block: Block, canvas: Canvas) -> None:
        """Takes the rows of a run: their means lengthen the trail, the last one is the dot."""
        x, y = self._plane.of(block, self._ratio)
        x, y = averaged(block.t, x, y, self._plane.mean)
        if not len(x):
            return
        t, before = float(block.t[-1]), self._count
        if self._refit(x, y):
            draw_frame(self._plane.path, t, self._frame, canvas)
            before = 0
        for point in zip(x.tolist(), y.tolist(), strict=True):
            self._append(*point)
        for number, piece in self._pieces:
            if number >= before - 1:
                self._draw(t, number, piece, canvas)
        canvas.dot(f"{self._plane.path}/now", t, self._frame.place(x[-1:], y[-1:]), colours.NOW)

    def _append(self, x: float, y: float) -> None:
        piece = self._pieces[-1][1] if self._pieces else None
        if piece is None:
            self._start(Piece(1, [x], [y]))
            return
        dx = (x - piece.x[-1]) / (self._frame.x.high - self._frame.x.low)
        dy = (y - piece.y[-1]) / (self._frame.y.high - self._frame.y.low)
        if abs(dx) < APART and abs(dy) < APART:
            return
        piece.x.append(x)
        piece.y.append(y)
        turned = piece.turned(BACK * (self._frame.x.high - self._frame.x.low))
        if turned is not None:
            self._start(piece.split(turned, -piece.way))
        elif len(piece.x) >= PIECE:
            self._start(piece.split(len(piece.x) - 1, piece.way))

    def _start(self, piece: Piece) -> None:
        self._pieces.append((self._count, piece))
        self._count += 1

    def _refit(self, x: Array, y: Array) -> bool:
        xs = np.concatenate((x, *(p.x for _, p in self._pieces)))
        ys = np.concatenate((y, *(p.y for _, p in self._pieces)))
        fitted = Frame(
            self._frame.x.fitted(float(xs.min()), float(xs.max())),
            self._frame.y.fitted(float(ys.min()), float(ys.max())),
        )
        changed = fitted.x is not self._frame.x or fitted.y is not self._frame.y
        self._frame = fitted
        return changed

    def _draw(self, t: float, number: int, piece: Piece, canvas: Canvas) -> None:
        points = self._frame.place(np.array(piece.x), np.array(piece.y))
        colour = colours.FORWARD if piece.way > 0 else colours.REVERSE
        pen = Pen(colour, 1.5, 1.0)
        canvas.lines(f"{self._plane.path}/trail/{number % PIECES:02d}", t, [points] if len(points) > 1 else [], pen)


def averaged(t: Array, x: Array, y: Array, mean: float) -> tuple[Array, Array]:
    """Means of `x` and `y` (n,) over stretches of `mean` s of `t` (n,), rows with a NaN left out."""
    here = np.isfinite(x) & np.isfinite(y)
    t, x, y = t[here], x[here], y[here]
    if not len(t):
        return x, y
    stretch = np.floor(t / mean).astype(np.int64)
    starts = np.concatenate(([0], np.flatnonzero(np.diff(stretch)) + 1))
    rows = np.diff(np.append(starts, len(t)))
    return np.add.reduceat(x, starts) / rows, np.add.reduceat(y, starts) / rows


def twist(block: Block, ratio: float) -> Array:
    """Wind-up [rad] at the output, shape (n,)."""
    return transmission_error(block["theta_m"], block["theta_l"], ratio)


def torque(block: Block) -> Array:
    """Motor torque [N·m]: what the drive was given; where that is no torque or not known, what it reports."""
    given = block["tau_applied"]
    return block["tau_m"] if np.isnan(given).all() else given
