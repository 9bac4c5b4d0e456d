"""The shaft torque of a lock test that nobody read: what the spring makes of the wind-up both encoders show.

    T = K·(θ_m/N − θ_l − θ̃_p(θ_m) − φ_0)                                                [ghorbel2001, Eqs. 1, 2, 4]

The clamp turns the output a little, so φ_0 is each test's own: where the motor's torque less its friction is nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.smoothing import flat_rate
from rig.model.effect import Array, Known
from rig.model.waves import sums

SLIDING: Final = 0.5  # of the median speed: slower, and the motor's friction has no sure sign
FEWEST: Final = 50  # rows
NOTHING: Final = 1e-9  # rad: what rounding leaves where one angle stands in for the other
SOFTEST, STIFFEST = 0.3, 3.0  # of the declared K: further off, and the motor winds another spring


@dataclass(frozen=True)
class Wound:
    """The torque T of a lock test [N·m], (n,), and the spring's K [N·m/rad] by which it was told: as steep as the
    motor's torque says, so that both are in the motor's units. `bent` (n,) is the torque by a spring that may bend, as
    a cubic: what effects go by, for one that hardens by a fifth winds a fifth less. `local` (n,) is its slope."""

    torque: Array
    K: float
    bent: Array
    local: Array


def wound(theta_m: Array, theta_l: Array, tau_m: Array, ratio: float, gear: Known, dt: float) -> Wound | None:
    """From angles and the motor's torque as read, (n,); None where the motor winds no spring of about `gear.K`."""
    error, slope = sums(gear.kinematic_error, theta_m, 0, 1)
    phi = theta_m / ratio - theta_l - error
    rate = flat_rate(theta_m, dt, 1)
    sliding = np.abs(rate) > SLIDING * float(np.median(np.abs(rate)))
    n = np.count_nonzero(sliding)
    if n < FEWEST or not (np.isfinite(phi).all() and np.isfinite(tau_m).all() and np.ptp(phi) > NOTHING):
        return None
    middle = float(np.mean(phi[sliding]))
    x = phi - middle
    lever = 1.0 - ratio * slope  # by which the torque reaches the motor
    beside = np.stack([np.sign(rate[sliding]), np.ones(n)], 1)

    def told(*powers: Array) -> Array:
        columns = np.hstack([np.stack([p * lever for p in powers], 1)[sliding], beside])
        found, *_ = np.linalg.lstsq(columns, ratio * tau_m[sliding], rcond=None)
        return np.asarray(found)

    K, _, rest = told(x)
    if not SOFTEST < K / gear.K < STIFFEST:
        return None
    most = float(np.max(np.abs(x)))
    u = x / most
    a, b, c, _, level = told(u, u**2, u**3)
    bent, local = level + u * (a + u * (b + u * c)), (a + u * (2.0 * b + u * 3.0 * c)) / most
    return Wound(K * x + rest, float(K), bent, local)
