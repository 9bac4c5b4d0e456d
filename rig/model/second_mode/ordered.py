"""What a motor that turns steadily makes again and again: the orders of a signal, without the noise between them. It
shakes housings, and inertias on motor and load."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Signals
from rig.model.fourier import PAPER_ORDERS
from rig.model.second_mode.shaken import EXCITED

Array = npt.NDArray[np.float64]

FAST: Final = 36.0  # Hz of a mode above which what shakes it is taken from its orders alone
TURNS: Final = 8  # of the motor over which an order is the same
STEADY: Final = 0.1  # of the mean speed, how far nine tenths of a piece may vary
NYQUIST: Final = 0.45  # of the rows' rate


def ordered(s: Signals, x: Array) -> Array:
    """The mean and the orders of `x` (n,) over the turns around each row, where the motor turns fast and steadily for
    long enough; `x` itself elsewhere. A sharp resonance makes more of the noise between them than of what shakes it.
    """
    windows = s.once("turns around", lambda: _windows(s))
    if windows is None:
        return x
    low, high = windows
    speed = float(np.mean(np.abs(s.omega_m)))
    top = min(PAPER_ORDERS, int(NYQUIST * 2.0 * np.pi / (s.dt * speed)))
    out = _mean(np.nan_to_num(x), low, high)
    for n in range(1, top + 1):
        wave = np.exp(1j * n * s.theta_m)
        out = out + 2.0 * (_mean(np.nan_to_num(x) * wave.conj(), low, high) * wave).real
    return np.asarray(out)


def shaking(s: Signals, name: str, x: Array, hz: float) -> Array:
    """What shakes a mode of `hz`: `x` (n,), the signal of that `name`, or its orders alone where that is fast."""
    return s.once(f"orders of {name}", lambda: ordered(s, x)) if hz > FAST else x


def _windows(s: Signals) -> tuple[Array, Array] | None:
    """Where whole turns around each row begin and end, in rows and parts of them (n,); None where there are none."""
    gone = np.abs(s.theta_m - s.theta_m[0]) if s.t.size else np.zeros(0)
    wide = 2.0 * np.pi * TURNS
    if not gone.size or gone[-1] < wide:
        return None
    speed = np.abs(s.omega_m)
    slow, fast = np.percentile(speed, (5, 95))
    if slow < EXCITED or fast - slow > STEADY * float(speed.mean()):
        return None
    gone, rows = np.maximum.accumulate(gone), np.arange(gone.size, dtype=np.float64)
    begin = np.clip(gone - wide / 2.0, 0.0, gone[-1] - wide)
    return np.interp(begin, gone, rows), np.interp(begin + wide, gone, rows)


def _mean(x: npt.NDArray[Any], low: Array, high: Array) -> npt.NDArray[Any]:
    """Of `x` (n,) between those rows, (n,)."""
    sums = np.concatenate([np.zeros(1, x.dtype), np.cumsum(x)])

    def until(row: Array) -> npt.NDArray[Any]:
        whole = row.astype(np.int64)
        return np.asarray(sums[whole] + (row - whole) * x[np.minimum(whole, x.size - 1)])

    return np.asarray((until(high) - until(low)) / (high - low))
