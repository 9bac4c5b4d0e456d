"""The shaft torque of a lock test that nobody read: what the spring makes of the wind-up both encoders show.

    T = K·(θ_m/N − θ_l − θ̃_p(θ_m) − φ_0)                                                [ghorbel2001, Eqs. 1 and 5]

The clamp turns the output a little, so φ_0 is each test's own: where the motor's torque less its friction is nothing.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.smoothing import flat_rate
from rig.model.effect import Array, Known
from rig.model.waves import sums

SLIDING: Final = 0.5  # of the median speed: slower, and the motor's friction has no sure sign
FEWEST: Final = 50  # rows
NOTHING: Final = 1e-9  # rad or N·m: what rounding leaves where one angle stands in for the other
SOFTEST, STIFFEST = 0.3, 3.0  # of the torque that K has: further off, and the motor winds another spring


def wound_torque(theta_m: Array, theta_l: Array, tau_m: Array, ratio: float, gear: Known, dt: float) -> Array:
    """T, N·m, (n,), from angles and the motor's torque as read; NaN where the motor winds no spring."""
    wound = theta_m / ratio - theta_l - sums(gear.kinematic_error, theta_m, 0)[0]
    line = _line(wound, flat_rate(theta_m, dt, 1), tau_m)
    return np.full(wound.size, np.nan) if line is None else np.asarray(gear.K * (wound - line[1]))


def winds(torque: Array, tau_m: Array, theta_m: Array, ratio: float, dt: float) -> bool:
    """Whether the motor holds about an Nth of the `torque` that the wind-up says, N·m, (n,): what it winds otherwise is
    another spring."""
    line = _line(torque, flat_rate(theta_m, dt, 1), tau_m)
    return line is not None and SOFTEST < line[0] * ratio < STIFFEST


def _line(wound: Array, rate: Array, tau_m: Array) -> tuple[float, float] | None:
    """Of the motor's torque less its friction by what is `wound` (n,): how steep, and where it is nothing."""
    sliding = np.abs(rate) > SLIDING * float(np.median(np.abs(rate)))
    n = np.count_nonzero(sliding)
    if n < FEWEST or not (np.isfinite(wound).all() and np.isfinite(tau_m).all() and np.ptp(wound) > NOTHING):
        return None
    middle = float(np.mean(wound[sliding]))
    columns = np.stack([wound[sliding] - middle, np.sign(rate[sliding]), np.ones(n)], 1)
    (slope, _, rest), *_ = np.linalg.lstsq(columns, tau_m[sliding], rcond=None)
    return (float(slope), middle - float(rest / slope)) if slope > 0 else None
