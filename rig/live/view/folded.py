"""Kinematic error against wave-generator angle: the last turns over the running mean, the present one on top."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

import numpy as np

from rig.core.units import ARCSEC
from rig.live.calm import Calm
from rig.live.view import colours
from rig.live.view.axes import HEIGHT, WIDTH, Axis, Frame
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas, Pen
from rig.live.view.drawing import Drawing, draw_frame
from rig.live.view.turns import BINS, Turn, Turns
from rig.model.transmission_error import transmission_error

Array = np.ndarray[Any, Any]

PATH = "/folded"
LAST = 6  # turns shown singly
MIDDLES = (np.arange(BINS) + 0.5) * 360.0 / BINS  # deg
SIDES = {
    1: ("forward", colours.FORWARD, colours.FORWARD_SOFT, 5.0),
    -1: ("reverse", colours.REVERSE, colours.REVERSE_SOFT, 2.0),
}  # the one drawn later is thinner: they often lie upon each other


class Side:
    """One direction: the last turns, each less its own mean, and the mean of all."""

    def __init__(self) -> None:
        self.last: deque[Array] = deque(maxlen=LAST)
        self.count = 0
        self._sum, self._rows = np.zeros(BINS), np.zeros(BINS)

    def add(self, turn: Turn) -> None:
        """One more turn, less its mean: load and wind-up move the whole curve, and slowly."""
        curve = turn.values - np.nanmean(turn.values)
        there = np.isfinite(curve)
        self.last.append(curve)
        self._sum[there] += curve[there]
        self._rows += there
        self.count += 1

    @property
    def mean(self) -> Array:
        """arcsec, shape (BINS,); NaN where no turn had a row."""
        return np.asarray(np.where(self._rows > 0, self._sum / np.maximum(self._rows, 1), np.nan))


class Folded(Drawing):
    """θ̃ = θ_m/N − θ_l over one motor turn, arcsec at the output, means of 1° of motor angle."""

    def __init__(self, ratio: float, banner: str) -> None:
        self._ratio, self._banner = ratio, banner
        self._calm, self._turns = Calm(), Turns()
        self._sides = {1: Side(), -1: Side()}
        self._peak = ""
        x = Axis("wave-generator angle", "deg", 0.0, 360.0, step=45.0)
        self._frame = Frame(x, Axis("θ̃ less its mean, at the output", "arcsec", -60.0, 60.0, most=8))

    def draw(self, t: float, canvas: Canvas) -> None:
        """Frame, sides and banner as they stand at run time `t` s."""
        if self._banner:
            where = np.array([[WIDTH - 16.0, -10.0]], dtype=np.float32)
            canvas.words(f"{PATH}/banner", None, where, [self._banner], colours.MARK)
        self._draw_done(t, canvas)

    def add(self, block: Block, canvas: Canvas) -> None:
        """Takes the rows of a run in progress; a whole turn is drawn into its side, a part of one upon it."""
        theta = block["theta_m"]
        error = transmission_error(theta, block["theta_l"], self._ratio) / ARCSEC
        here = self._calm.of(block.t, block["flags"]) & np.isfinite(theta) & np.isfinite(error)
        if not here.any():
            return
        t = float(block.t[-1])
        done = self._turns.add(theta[here], error[here])
        for turn in done:
            self._sides[turn.way].add(turn)
            if not math.isnan(turn.peak_to_peak):
                self._peak = f"last turn {turn.peak_to_peak:.1f} arcsec peak to peak"
        now = self._present(self._turns.partial)
        if self._refit(now) or done:
            self._draw_done(t, canvas)
        self._draw_now(t, now, math.degrees(theta[here][-1]) % 360.0, canvas)

    def over(self, t: float, canvas: Canvas) -> None:
        """Where it came to rest the gear unwound: that is no error of a turn."""
        now = self._present(self._turns.stopped)
        there = MIDDLES[np.isfinite(now)]
        end = float(there[-1 if self._turns.way > 0 else 0]) if len(there) else 0.0
        self._draw_now(t, now, end, canvas)

    def _present(self, now: Array) -> Array:
        """The present turn, laid upon the mean of its side as far as it goes."""
        there = np.isfinite(now)
        side = self._sides.get(self._turns.way)
        offset = np.nanmean(now[there]) if there.any() else 0.0
        beside = now - side.mean if side is not None and side.count else np.full(BINS, np.nan)
        if np.isfinite(beside).any():
            offset = np.nanmean(beside)
        return np.asarray(now - offset)

    def _refit(self, now: Array) -> bool:
        """True when the axis changed: everything has to be drawn anew."""
        shown = [now, *(c for side in self._sides.values() for c in (*side.last, side.mean))]
        values = np.concatenate(shown)
        values = values[np.isfinite(values)]
        fitted = self._frame.y.fitted(float(values.min()), float(values.max())) if len(values) else self._frame.y
        changed = fitted is not self._frame.y
        self._frame = Frame(self._frame.x, fitted)
        return changed

    def _draw_done(self, t: float, canvas: Canvas) -> None:
        draw_frame(PATH, t, self._frame, canvas)
        for side, (name, colour, soft, width) in zip(self._sides.values(), SIDES.values(), strict=True):
            if side.count:
                last = [self._frame.place(MIDDLES, curve) for curve in side.last]
                canvas.lines(f"{PATH}/{name}/last", t, last, Pen(soft, 1.0, 0.0))
                canvas.lines(f"{PATH}/{name}/mean", t, [self._frame.place(MIDDLES, side.mean)], Pen(colour, width, 2.0))
        self._legend(t, canvas)

    def _draw_now(self, t: float, now: Array, angle: float, canvas: Canvas) -> None:
        """The present turn, and a dot where it is at `angle` deg of it."""
        line = self._frame.place(MIDDLES, now)
        canvas.lines(f"{PATH}/now/line", t, [line] if len(line) > 1 else [], Pen(colours.NOW, 1.5, 4.0))
        value = now[min(int(angle * BINS / 360.0), BINS - 1)]
        place = self._frame.place(np.array([angle]), np.array([value]))
        canvas.dot(f"{PATH}/now/dot", t, place, colours.NOW)

    def _legend(self, t: float, canvas: Canvas) -> None:
        for x, side, (name, colour, _, _) in zip((30.0, 96.0), self._sides.values(), SIDES.values(), strict=True):
            text = f"{name}, mean of {side.count} turn{'s' if side.count > 1 else ''}" if side.count else name
            canvas.words(f"{PATH}/{name}/words", t, np.array([[x, 3.0]], dtype=np.float32), [text], colour)
        if self._peak:
            where = np.array([[WIDTH - 52.0, HEIGHT - 12.0]], dtype=np.float32)
            canvas.words(f"{PATH}/peak", t, where, [self._peak], colours.INK)
