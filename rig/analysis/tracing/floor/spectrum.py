"""Power of a residual by frequency, over what is usual around it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rig.model.effect import Array

ZOOM = 4  # finer than a run's own resolution
AROUND = 1.5  # Hz on each side make the background


def on_even_grid(t: Array, e: Array) -> tuple[Array, float, npt.NDArray[np.int64]]:
    """Rows (n,) at times `t` s on an even grid, 0 where there is none, its step, s, and the place of each row (n,)."""
    dt = float(np.median(np.diff(t)))
    place = np.minimum(np.round((t - t[0]) / dt).astype(np.int64), round((t[-1] - t[0]) / dt))
    out = np.zeros(int(place[-1]) + 1)
    out[place] = e
    return out, dt, place


def over_usual(x: Array, dt: float) -> tuple[Array, Array]:
    """Hz and power over the usual one, (m,) each, of `x` (n,) in steps of `dt` s."""
    n = ZOOM * x.size
    power = np.abs(np.fft.rfft(x * np.hanning(x.size), n)) ** 2
    hz = np.asarray(np.fft.rfftfreq(n, dt), dtype=np.float64)
    width = max(1, int(AROUND / hz[1]))
    coarse = power[: power.size // width * width].reshape(-1, width)
    usual = np.interp(np.arange(power.size), (np.arange(len(coarse)) + 0.5) * width, np.median(coarse, axis=1))
    return hz, np.asarray(power / np.maximum(usual, 1e-300))
