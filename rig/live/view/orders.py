"""Which orders per motor turn the kinematic error has, over the last turns in one direction."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from rig.analysis.orders import spectrum
from rig.live.view import colours
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas
from rig.live.view.curves import ARCSEC
from rig.live.view.drawing import Drawing
from rig.live.view.turns import BINS, TURN, Turn, Turns

Array = np.ndarray[Any, Any]

PATH = "/orders"
SPAN = 16  # turns at most
HIGHEST = 16.0  # order
STEP = 0.25  # of an order a bar stands for
LEAST = 2  # turns: with one, order 1 and slow change are the same


class Orders(Drawing):
    """Drawn anew after every whole turn; begins anew after a reversal."""

    def __init__(self, ratio: float) -> None:
        self._ratio = ratio
        self._turns = Turns()
        self._last: deque[Turn] = deque(maxlen=SPAN)

    def draw(self, t: float, canvas: Canvas) -> None:
        at = np.arange(0.0, HIGHEST + STEP / 2, STEP)
        at, amplitude = bars(list(self._last)) if len(self._last) >= LEAST else (at, np.zeros_like(at))
        canvas.bars(PATH, t, at, amplitude, colours.FORWARD)

    def add(self, block: Block, canvas: Canvas) -> None:
        theta, error = block["theta_m"], (block["theta_m"] / self._ratio - block["theta_l"]) * ARCSEC
        here = np.isfinite(theta) & np.isfinite(error)
        done = self._turns.add(theta[here], error[here])
        for turn in done:
            if self._last and (turn.way != self._last[-1].way or turn.number != self._last[-1].number + turn.way):
                self._last.clear()
            self._last.append(turn)
        if done and len(self._last) >= LEAST:
            canvas.bars(PATH, float(block.t[-1]), *bars(list(self._last)), colours.FORWARD)


def bars(turns: list[Turn]) -> tuple[Array, Array]:
    """Orders and amplitudes [arcsec] of turns that follow each other, the largest within half a STEP of each order."""
    turns = sorted(turns, key=lambda turn: turn.number)
    theta = np.concatenate([(turn.number + (np.arange(BINS) + 0.5) / BINS) * TURN for turn in turns])
    values = np.concatenate([turn.values for turn in turns])
    here = np.isfinite(values)
    theta, values = theta[here], values[here]
    slope = np.polynomial.Polynomial.fit(theta, values, 1)  # wind-up and eccentricity change slowly
    orders, amplitude = spectrum(theta, values - slope(theta), HIGHEST + STEP)
    at = np.arange(0.0, HIGHEST + STEP / 2, STEP)
    place = np.rint(orders / STEP).astype(np.int64)
    largest = np.zeros_like(at)
    inside = place < len(at)
    np.maximum.at(largest, place[inside], amplitude[inside])
    return at, largest
