"""Which orders per motor turn the kinematic error has, over the last turns in one direction."""

from __future__ import annotations

from collections import deque
from typing import Any

import numpy as np

from rig.core.units import ARCSEC
from rig.live.calm import Calm
from rig.live.view import colours
from rig.live.view.block import Block
from rig.live.view.canvas import Canvas
from rig.live.view.drawing import Drawing
from rig.live.view.turns import BINS, Turn, Turns
from rig.model.transmission_error import transmission_error

Array = np.ndarray[Any, Any]

PATH = "/orders"
SPAN = 16  # turns at most
LOWEST, HIGHEST = 0.5, 16.0  # orders; below is what changes slowly: load, eccentricity of the output
STEP = 0.25  # of an order a bar stands for
ROWS_PER_ORDER = 4  # bins with rows a turn must have for each order: twice what Nyquist asks
LEAST = 2  # turns: with one, order 1 and slow change are the same
ENOUGH = 4  # turns, a resolution of STEP: until then the stroke before stays


class Orders(Drawing):
    """Drawn anew after every whole turn of one stroke; after a reversal once the new stroke has ENOUGH turns."""

    def __init__(self, ratio: float) -> None:
        self._ratio = ratio
        self._calm, self._turns = Calm(), Turns()
        self._last: deque[Turn] = deque(maxlen=SPAN)
        self._shown: list[Turn] = []

    def draw(self, t: float, canvas: Canvas) -> None:
        """The bars as they stand at run time `t` s, arcsec over orders of the motor turn; empty before two turns."""
        at = np.arange(0.0, HIGHEST + STEP / 2, STEP)
        at, amplitude = bars(self._shown) if self._shown else (at, np.zeros_like(at))
        canvas.bars(PATH, t, at, amplitude, colours.FORWARD)

    def add(self, block: Block, canvas: Canvas) -> None:
        """Takes the rows of a run; the bars are drawn anew when a whole turn has come."""
        theta = block["theta_m"]
        error = transmission_error(theta, block["theta_l"], self._ratio) / ARCSEC
        here = self._calm.of(block.t, block["flags"]) & np.isfinite(theta) & np.isfinite(error)
        done = self._turns.add(theta[here], error[here])
        for turn in done:
            if self._last and (turn.way != self._last[-1].way or turn.number != self._last[-1].number + turn.way):
                self._last.clear()
            self._last.append(turn)
        if done and len(self._last) >= (ENOUGH if self._shown else LEAST):
            self._shown = list(self._last)
            canvas.bars(PATH, float(block.t[-1]), *bars(self._shown), colours.FORWARD)


def bars(turns: list[Turn]) -> tuple[Array, Array]:
    """Orders and amplitudes [arcsec] of turns that follow each other, the largest within half a STEP of each order.

    Over a whole number of turns a line of a whole order is one bar; one between orders spreads to its neighbours.
    Nothing is shown of orders for which the rows of a turn are too few.
    """
    turns = sorted(turns, key=lambda turn: turn.number)
    values = np.stack([_filled(turn.values) for turn in turns])
    means = values.mean(axis=1)
    slope = (means[-1] - means[0]) / (len(turns) - 1)  # a turn, of what changes slowly; lines have none
    values = values.ravel() - slope * (np.arange(values.size) + 0.5) / BINS
    amplitude = np.abs(np.fft.rfft(values - values.mean())) * 2.0 / values.size
    at = np.arange(0.0, HIGHEST + STEP / 2, STEP)
    place = np.rint(np.arange(amplitude.size) / len(turns) / STEP).astype(np.int64)
    largest = np.zeros_like(at)
    seen = min(int(np.isfinite(turn.values).sum()) for turn in turns)
    inside = (place < len(at)) & (place * STEP <= seen / ROWS_PER_ORDER) & (place * STEP >= LOWEST)
    np.maximum.at(largest, place[inside], amplitude[inside])
    return at, largest


def _filled(values: Array) -> Array:
    """Bins without a row from their neighbours."""
    here = np.isfinite(values)
    return np.interp(np.arange(values.size), np.flatnonzero(here), values[here], period=values.size)
