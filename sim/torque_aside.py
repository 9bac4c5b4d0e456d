"""What a torque sensor shows beside the torque in its shaft."""

from __future__ import annotations

import math

from sim.effects import Sensors


class TorqueAside:
    """Bending, once and twice per output turn, a zero that drifts as it warms, pickup at a fixed frequency.

    c_1·cos(θ_l − ψ_1) + c_2·cos(2·θ_l − ψ_2) + z·(1 − e^{−t/T}) + A·sin(2π·f·t); no shaft feels any of it.
    """

    def __init__(self, s: Sensors) -> None:
        self._sensors = s
        self._phases = math.radians(s.crosstalk_phase_deg), math.radians(s.crosstalk_second_phase_deg)
        self._any = any((s.crosstalk, s.crosstalk_second, s.zero_drift, s.pickup))

    def __bool__(self) -> bool:
        """Whether it shows any of that."""
        return self._any

    def torque(self, t: float, theta_l: float) -> float:
        """N·m at `t` s and at the load's angle `theta_l` rad."""
        s, (psi_1, psi_2) = self._sensors, self._phases
        bending = s.crosstalk * math.cos(theta_l - psi_1) + s.crosstalk_second * math.cos(2.0 * theta_l - psi_2)
        zero = s.zero_drift * -math.expm1(-t / s.zero_drift_time)
        return bending + zero + s.pickup * math.sin(2.0 * math.pi * s.pickup_hz * t)
