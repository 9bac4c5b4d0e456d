"""The paper's central measurement: turn the wave generator very slowly and watch what the output does not follow."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from rig.control.pid import Pid
from rig.control.profile import Triangle
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import DEG, RPM
from rig.procedures.whole_turns import too_short


@dataclass(frozen=True)
class KinematicError(Procedure):
    """Follow a slow triangle with the motor, output free: the pure kinematic error      [ghorbel2001, Eq. 1]

    4·A·f = 57.6°/s = 9.6 rpm with the defaults. One stroke is 16 motor turns but only 115° of output.
    """

    name: ClassVar[str] = "kinematic_error"
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")
    has_reference: ClassVar[bool] = True

    amplitude_deg: float = 1440.0  # deg of the motor, zero to peak
    frequency: float = 0.01  # Hz, of the triangle; speed = 4·amplitude·frequency
    cycles: float = 2.0  # of the triangle
    settle: float = 0.5  # s at rest before and after: the loop takes hold of the measured position

    def __post_init__(self) -> None:
        if self.cycles * 2 % 1 != 0:
            raise UsageError(
                f"cycles = {self.cycles:g}: expected a multiple of 0.5, so that the reference ends where it began"
            )

    @property
    def reference(self) -> Triangle:
        """Motor angle from where it starts."""
        return Triangle(self.amplitude_deg * DEG, self.frequency, self.cycles)

    def envelope(self, setting: Setting) -> Envelope:
        """Travel is the amplitude; the torque is what the position loop may give."""
        wave = self.reference
        return Envelope(wave.duration + 2 * self.settle, wave.amplitude, wave.speed, setting.control.torque_limit)

    def remarks(self, setting: Setting) -> list[str]:
        """Of strokes too short for a figure."""
        return too_short(self.reference)

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        speed = self.reference.speed / RPM
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": round(speed, 6)}

    def steps(self, setting: Setting) -> Steps:
        """Hold where it is, follow the triangle, hold again."""
        pid, wave = Pid(setting.control, setting.period), self.reference
        sample = yield Torque(0.0)
        home, begin, end = sample.theta_m, self.settle, self.settle + wave.duration
        setting.note(f"reference starts from the measured motor angle {home / DEG:.2f}°")
        while sample.t < end + self.settle:
            offset, omega_ref = wave.at(sample.t - begin)
            theta_ref = home + offset
            tau = pid.step(theta_ref, omega_ref, sample.theta_m, sample.omega_m)
            sample = yield Torque(tau, theta_ref, omega_ref)
