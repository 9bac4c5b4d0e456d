"""What a position loop on the host is made with."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Gains:
    """Motor-side gains: torque over motor angle."""

    Kp: float  # N·m/rad
    Ki: float  # N·m/(rad·s)
    Kd: float  # N·m·s/rad
    integrator_limit: float  # N·m, of the integral part alone
    torque_limit: float  # N·m, of the whole
    feedforward: float = 0.0  # N·m·s/rad, viscous drag expected at the reference's speed
