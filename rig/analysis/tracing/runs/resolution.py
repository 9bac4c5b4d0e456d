"""How fine a reading is: its white noise, the step of its encoder, and the low-pass that suits a coarse one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rig.analysis.motion.smallest_step import smallest_step
from rig.analysis.tracing.thresholds import BANDWIDTH
from rig.model.effect import Array

KEPT = 0.98  # of the differences: all but the largest
OF_KEPT = 0.7598  # their mean, of normal ones of RMS 1


COARSE = 2 * np.pi / 6000  # rad, a count of the motor encoder; 8192 a turn do no harm, 4096 do


FINE = 2 * np.pi / 10_000  # rad, a count that needs no lower low-pass; of 2000 J_m is 17 % off at 12 Hz, right at 7


FINEST = 2 * np.pi / 2**26  # rad, a count of an encoder: less is what rounding leaves of a number


WHOLE = 0.02  # of a step, how far an angle may be from whole ones


SLOWEST = 3.0  # Hz, the lowest low-pass: with it a piece of 3 s is still ten times as long as the filter


def quiet(theta_m: Array | None, encoders: Mapping[str, float], most: float = BANDWIDTH) -> float:
    """Hz of low-pass that suits the motor encoder, `most` for a fine one: a position loop answers the rounding of a
    coarse one with torque, and what the low-pass leaves of both looks like a smaller J_m, a negative one even."""
    step = 0.0 if theta_m is None else _count(theta_m, encoders)
    return max(SLOWEST, BANDWIDTH * FINE / step) if step > COARSE else most


def noise_of(name: str, x: Array, encoders: Mapping[str, float], t: Array | None = None) -> float:
    """RMS noise of a reading, taken at the times `t` where its clock is uneven; of a motor encoder of known counts no
    more than rounding: the loop may shake it. And no less: while it moves by less than a count a row it looks free of
    noise."""
    counts = float(encoders.get("motor_counts_per_rev") or 0.0)
    if name == "theta_m" and counts > 0:
        return float(min(max(rough(x, t), _count(x, encoders) / 12**0.5), 2 * np.pi / counts / 12**0.5))
    return rough(x, t)


def counts_of(x: Array | None, declared: float) -> float:
    """Counts per turn of an encoder: as declared, or where nothing is, as the angle (n,) in rad shows that is whole
    steps from its first row; 0 where it is none."""
    if declared > 0 or x is None or (step := smallest_step(x)) <= 0:
        return declared
    known = x[np.isfinite(x)]
    steps = (known - known[0]) / step
    return 2 * np.pi / step if step > FINEST and np.all(np.abs(steps - np.round(steps)) < WHOLE) else 0.0


def _count(theta_m: Array, encoders: Mapping[str, float]) -> float:
    """rad of one count, as declared, or less where the reading is finer than that; 0 where nothing is declared."""
    counts = float(encoders.get("motor_counts_per_rev") or 0.0)
    return min(2 * np.pi / counts, smallest_step(theta_m)) if counts > 0 else 0.0


def rough(x: Array, t: Array | None = None) -> float:
    """RMS of the white noise in a reading (n,), at the times `t` (n,) in s where they are uneven.

    The fourth difference of white noise has 70 times its variance; reversals and jumps are in the largest few, which
    are left out. Of a reading in counts it takes a handful of values: their mean is as good as ever, the median is one
    of them, up to a quarter off, and with it the noise that a fit allows for in an acceleration. Differences row by row
    on a clock that is early or late would take the motion between for noise: a J_l a tenth off.
    """
    d = np.abs(np.diff(x, 4) / 70**0.5 if t is None else _divided(x, t))
    d = d[np.isfinite(d)]
    if not d.size:
        return float("nan")
    kept = np.partition(d, k := min(int(KEPT * d.size), d.size - 1))[: k + 1]
    return float(np.mean(kept) / OF_KEPT)


def _divided(x: Array, t: Array) -> Array:
    """Divided differences of five rows each (n - 4,): of a cubic nothing is left in them, of white noise its RMS."""
    at = [t[i : t.size - 4 + i] for i in range(5)]
    with np.errstate(divide="ignore", invalid="ignore"):  # two rows at one time: not finite, and left out
        weights = [1.0 / np.prod([at[i] - at[j] for j in range(5) if j != i], axis=0) for i in range(5)]
        sum_of = sum(w * x[i : x.size - 4 + i] for i, w in enumerate(weights))
        return np.asarray(sum_of / np.sqrt(sum(w * w for w in weights)))
