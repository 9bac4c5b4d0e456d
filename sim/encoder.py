"""What an encoder's scale and reading head make of the true angle."""

from __future__ import annotations

import math

from sim.effects import Sensors

Line = tuple[float, float, float]  # order per turn of the shaft, amplitude [rad], phase [rad]


class Scale:
    """θ + Σ a·sin(n·θ − ψ): eccentricity n = 1, ellipticity n = 2, interpolation n = lines per turn.

    A fault of the sensor alone: nothing turns by it, and speed does not make it larger.
    """

    __slots__ = ("lines",)

    def __init__(self, *lines: Line) -> None:
        self.lines = tuple(line for line in lines if line[1] != 0.0)

    def shown(self, theta: float) -> float:
        """The angle the scale shows at the true angle `theta` rad."""
        return theta + sum(a * math.sin(n * theta - psi) for n, a, psi in self.lines)


def motor_scale(s: Sensors) -> Scale:
    """Of the motor's encoder."""
    return Scale(
        _line(1, s.motor_eccentricity_deg, s.motor_eccentricity_phase_deg),
        _line(s.motor_lines, s.motor_interpolation_deg, 0.0),
    )


def load_scale(s: Sensors) -> Scale:
    """Of the load encoder."""
    return Scale(
        _line(1, s.load_eccentricity_deg, s.load_eccentricity_phase_deg),
        _line(2, s.load_ellipticity_deg, s.load_ellipticity_phase_deg),
        _line(s.load_lines, s.load_interpolation_deg, 0.0),
    )


def _line(order: int, amplitude_deg: float, phase_deg: float) -> Line:
    return float(order), math.radians(amplitude_deg), math.radians(phase_deg)
