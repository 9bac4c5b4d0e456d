"""Speed ripple too fast for the speed windows: from the spectrum of the angle, where counting noise is a flat floor.

A window of 40 ms hides a loop that hunts at 45 Hz almost wholly. The angle shows it: ripple of 10 % of 9.6 rpm at 45 Hz
is half a count of a 10 000-count encoder, a clear line in a spectrum over whole strokes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.strokes import Stroke

BOTTOM_HZ = 5.0  # slower ripple is the windows' business
TOP_HZ = 150.0  # a position loop at 1 kHz does not hunt faster
FLOOR = (0.70, 0.95)  # of the Nyquist frequency: nothing mechanical up there, the counting noise alone
LN2 = 0.693  # median over mean of a periodogram's values


class FastRipple(NamedTuple):
    """What the windows do not see, (rad/s)²."""

    variance: float
    peak_hz: float
    peak_variance: float  # within 1 Hz of the peak


def fast_ripple(t: Array, theta_m: Array, strokes: list[Stroke], window: float) -> FastRipple:
    """Over all strokes; `t` s and `theta_m` rad, shape (n,); `window` s of the speed values it stands beside."""
    bins, rows = np.zeros(int(TOP_HZ) + 1), 0
    for s in strokes:
        if s.stop - s.start >= 256:
            bins += (s.stop - s.start) * _variance_per_hz(t[s.start : s.stop], theta_m[s.start : s.stop], window)
            rows += s.stop - s.start
    if not rows:
        return FastRipple(0.0, float("nan"), 0.0)
    bins /= rows
    peak = int(np.argmax(bins))
    near = float(bins[max(peak - 1, 0) : peak + 2].sum())
    return FastRipple(max(float(bins.sum()), 0.0), float(peak), max(near, 0.0))


def _variance_per_hz(t: Array, theta: Array, window: float) -> Array:
    """Speed variance in bins of 1 Hz, centred on whole numbers, that a mean-difference over `window` s leaves out."""
    n = t.size
    even = np.linspace(t[0], t[-1], n)
    period = float(even[1] - even[0])
    x = np.interp(even, t, theta)
    place = np.linspace(-1.0, 1.0, n)
    x = x - np.polynomial.polynomial.polyval(place, np.polynomial.polynomial.polyfit(place, x, 3))
    hann = np.hanning(n)
    power = 2.0 * np.abs(np.fft.rfft(x * hann)) ** 2 / (n * float(hann @ hann))  # sums to the mean square of x
    f = np.fft.rfftfreq(n, period)
    nyquist = 0.5 / period
    floor = float(np.median(power[(f > FLOOR[0] * nyquist) & (f < FLOOR[1] * nyquist)])) / LN2
    seen = np.sinc(f * window / 2) ** 2  # gain of (mean of half a window − mean of the half before)
    use = (f >= BOTTOM_HZ) & (f <= min(TOP_HZ, 0.6 * nyquist))
    speed = (2 * np.pi * f[use]) ** 2 * (power[use] - floor) * (1.0 - seen[use] ** 2)
    return np.asarray(np.bincount(np.round(f[use]).astype(np.int64), speed, int(TOP_HZ) + 1), dtype=np.float64)
