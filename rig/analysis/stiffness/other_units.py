"""Whether the motor could have wound the gear up by what the torque sensor reads, and whether any gear winds up so."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.stiffness.measure import windup_of
from rig.core.units import DEG

MOST: Final = 3.0  # times N·τ_m: a gear gives less than that, and two sensors agree to some per cent
LEAST: Final = 0.05  # of N·τ_m: friction takes most of a small torque, and not that much of a large one
BY_THE_MOTOR: Final = 0.5  # of the wind-up that its angle goes: else it is held, and may be by a brake

WINDS: Final = 3.0 * DEG  # from end to end: some twenty times what the paper's gear winds up by at 10 N·m either way


def winds_beyond(motion: Motion) -> str:
    """A sentence where the wind-up θ_m/N − θ_l is no gear's; "" where it may be one's."""
    wound = float(np.ptp(windup_of(motion)))
    if wound < WINDS:
        return ""
    return (
        f"One of the angles seems to be in another unit: the gear would be wound up by {wound / DEG:.3g}° from end to "
        f"end, expected less than {WINDS / DEG:g}°; stiffness goes by it."
    )


def torques_apart(motion: Motion, tau_l: Array, tau_m: Array | None) -> str:
    """A sentence where the shaft's torque `tau_l` (n,) goes further than the motor's `tau_m` (n,) can drive it, or next
    to nowhere, N·m; "" where both may be right, or nothing tells."""
    if tau_m is None or not np.isfinite(tau_m).all() or not np.ptp(tau_m):
        return ""
    if np.ptp(motion.theta_m) / motion.ratio < BY_THE_MOTOR * np.ptp(windup_of(motion)):
        return ""
    driven = motion.ratio * float(np.ptp(tau_m))
    share = float(np.ptp(tau_l)) / driven
    if LEAST < share < MOST:
        return ""
    return (
        f"One of the torques seems to be in another unit: τ_l goes over {np.ptp(tau_l):.4g} N·m while the motor drives "
        f"it with N·τ_m over {driven:.4g} N·m, expected {LEAST:g} to {MOST:g} times as much; stiffness goes by τ_l."
    )
