"""Did the motor turn evenly enough for a slow run to mean what it says? Sticking, speed scatter, hunting."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.speed import Speed, motor_speed
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.sums import fit, harmonics, without
from rig.analysis.smoothness.fast_ripple import fast_ripple
from rig.core.units import RPM, TURN

STUCK_BELOW = 0.10  # of the nominal speed: below this the motor counts as stuck
STUCK_LIMIT = 0.02  # share of the time
SIGMA_LIMIT = 0.10  # of the nominal speed
LOCKED_ORDERS = 30  # ripple up to this order follows the motor angle: gear and motor, not the loop
HUNTING_SIGMA = 0.02  # speed scatter below which no frequency in it matters
HUNTING_SHARE = 0.25  # of the variance: a weaker peak is not called hunting


@dataclass(frozen=True)
class Smoothness:
    """How evenly the motor turned within the strokes, reversals left out."""

    nominal_rpm: float
    stuck: float  # share of the time
    sigma: float  # speed scatter over nominal
    hunting_hz: float  # strongest frequency of the speed that is not locked to the angle
    hunting_share: float  # of the speed's variance
    window: float  # s, behind each speed value

    @property
    def passed(self) -> bool:
        return self.within(1.0)

    def within(self, share: float) -> bool:
        """True when both figures stay within that share of their limits."""
        return self.stuck <= share * STUCK_LIMIT and self.sigma <= share * SIGMA_LIMIT

    @property
    def hunts(self) -> bool:
        loud = self.sigma >= HUNTING_SIGMA
        return bool(loud and self.hunting_share >= HUNTING_SHARE and np.isfinite(self.hunting_hz))


def _not_locked(theta: Array, deviation: Array) -> Array:
    """`deviation` less what repeats with the motor angle, orders 1 to LOCKED_ORDERS."""
    orders = min(LOCKED_ORDERS, deviation.size // 8)
    if orders < 1 or abs(theta[-1] - theta[0]) < 2 * TURN:  # one turn alone cannot tell angle from time
        return deviation

    def columns(lo: int, hi: int) -> Array:
        return harmonics(theta[lo:hi], orders)

    return without(columns, deviation, fit(columns, deviation))


class _Ripple:
    """The spectrum of the angle-free deviations, summed stroke by stroke."""

    def __init__(self, longest: int) -> None:
        self._longest = longest  # speed values of the longest stroke
        self._padded = 1 << int(np.ceil(np.log2(max(2 * longest, 16))))
        self._power = np.zeros(self._padded // 2 + 1)
        self._rows = 0

    def add(self, part: Array) -> None:
        window = np.hanning(part.size + 2)[1:-1]
        found = np.abs(np.fft.rfft((part - part.mean()) * window, self._padded)) ** 2
        self._power += found / np.sum(window**2) * part.size
        self._rows += part.size

    def hunting(self, step: float, variance: float) -> tuple[float, float]:
        """(frequency [Hz], share of `variance`) of the strongest line, over all strokes."""
        power, longest = self._power.copy(), self._longest
        frequency = np.fft.rfftfreq(self._padded, step)
        power[frequency < 3.0 / (longest * step)] = 0.0  # slower than three periods a stroke is drift
        if variance <= 0 or not power.any():
            return float("nan"), 0.0
        peak = int(np.argmax(power))
        wide = max(3 * self._padded // longest, 1)  # the line's own width under the window
        share = 2.0 * float(np.sum(power[max(peak - wide, 0) : peak + wide + 1]))
        return float(frequency[peak]), min(share / self._padded / (self._rows * variance), 1.0)


def nominal_rpm(motion: Motion, strokes: list[Stroke], reference: Array | None) -> float:
    """What the speed should have been: the slope of the reference where there is one, else the strokes' own mean."""
    if reference is not None and motion.t is not None:
        slopes = []
        for s in strokes:
            dt = float(motion.t[s.stop - 1] - motion.t[s.start])
            slopes.append(abs(float(reference[s.stop - 1] - reference[s.start])) / dt / RPM)
        if np.all(np.isfinite(slopes)) and min(slopes) > 0:
            return float(np.median(slopes))
    return float(np.median([abs(motion.speed_rpm(s.start, s.stop - 1)) for s in strokes]))


def smoothness(
    motion: Motion, strokes: list[Stroke], reference: Array | None = None, speed: Speed | None = None
) -> Smoothness | None:
    """Judge the strokes (cut at the reversals already); None without time or strokes."""
    if motion.t is None or not strokes:
        return None
    speed = speed or motor_speed(motion.t, motion.theta_m)
    nominal = nominal_rpm(motion, strokes, reference)
    spans = [np.searchsorted(speed.row, (s.start, s.stop)) for s in strokes]
    used = [(s, slice(*span)) for s, span in zip(strokes, spans, strict=True) if span[1] - span[0] >= 8]
    if not used or not nominal > 0:
        return None
    ripple = _Ripple(max(here.stop - here.start for _, here in used))
    square, stuck, count = 0.0, 0, 0
    for s, here in used:
        rpm = speed.omega[here] / RPM * s.direction
        stuck += int(np.count_nonzero(np.abs(rpm) < STUCK_BELOW * nominal))
        count += rpm.size
        deviation = rpm - rpm.mean()
        square += float(deviation @ deviation)
        ripple.add(_not_locked(motion.theta_m[speed.row[here].astype(np.int64)], deviation))
    variance = square / count
    hunting_hz, share = ripple.hunting(speed.window / 4, variance)
    fast = fast_ripple(motion.t, motion.theta_m, strokes, speed.window)
    whole = variance + fast.variance / RPM**2
    share *= variance / whole if whole else 0.0
    if whole and fast.peak_variance / RPM**2 / whole > share:
        hunting_hz, share = fast.peak_hz, fast.peak_variance / RPM**2 / whole
    variance = whole
    return Smoothness(nominal, stuck / count, float(np.sqrt(variance)) / nominal, hunting_hz, share, speed.window)
