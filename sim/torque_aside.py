"""What a torque sensor shows beside the torque in its shaft."""

from __future__ import annotations

import math
from collections.abc import Callable

from sim.effects import Sensors


def torque_aside(s: Sensors) -> Callable[[float, float], float] | None:
    """N·m by time [s] and angle of the load [rad]; None when there is nothing of it.

    Bending once and twice per output turn, a zero that drifts as it warms, pickup at a fixed frequency:
    c_1·cos(θ_l − ψ_1) + c_2·cos(2·θ_l − ψ_2) + z·(1 − e^{−t/T}) + A·sin(2π·f·t). No shaft feels any of it.
    """
    if not any((s.crosstalk, s.crosstalk_second, s.zero_drift, s.pickup)):
        return None
    psi_1, psi_2 = math.radians(s.crosstalk_phase_deg), math.radians(s.crosstalk_second_phase_deg)

    def torque(t: float, theta_l: float) -> float:
        bending = s.crosstalk * math.cos(theta_l - psi_1) + s.crosstalk_second * math.cos(2.0 * theta_l - psi_2)
        zero = s.zero_drift * -math.expm1(-t / s.zero_drift_time)
        return bending + zero + s.pickup * math.sin(2.0 * math.pi * s.pickup_hz * t)

    return torque
