"""How slow is slow enough: the same strokes at falling speeds, until the kinematic error no longer changes."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from rig.control.pid import Pid
from rig.control.profile import Triangle
from rig.core.errors import UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import DEG, RPM
from rig.procedures.speed_list import speeds_of
from rig.procedures.whole_turns import too_short

FEWEST = 3  # speeds: two to see a change, one more to see that it has ended
# At 60 rpm 10 000 counts a turn are 10 counts a millisecond: every row is then rounded alike, and the rounding follows
# the angle instead of averaging out.
DETUNE = 0.993  # of the speeds named
APART = 1.2  # ratio of neighbouring speeds at least: closer ones are not told apart when the run is cut


@dataclass(frozen=True)
class SpeedConvergence(Procedure):
    """Triangles of one amplitude at successively lower speed      [ghorbel2001]

    The figure is the fastest speed at which the waveform agrees with that of standstill within a tolerance. Each speed
    is run 0.7 % slower than named: round speeds beat with the rows.
    """

    name: ClassVar[str] = "speed_convergence"
    needs: ClassVar[tuple[str, ...]] = ("t", "theta_m", "theta_l")
    has_reference: ClassVar[bool] = True

    speeds_rpm: str = "60,40,30,20,15,9.6,4.8"  # of the motor, falling
    amplitude_deg: float = 1440.0  # deg of the motor, zero to peak
    cycles: int = 1  # at each speed, at least
    least: float = 60.0  # s at each speed, at least: where speed tells most, strokes are short
    settle: float = 0.5  # s at rest before each
    tolerance: float = 0.02  # of the waveform's rms: what counts as no longer changing

    def __post_init__(self) -> None:
        speeds = self.speeds
        if len(speeds) < FEWEST or any(not a >= APART * b for a, b in itertools.pairwise(speeds)):
            raise UsageError(
                f"speeds_rpm = {self.speeds_rpm}: expected at least {FEWEST} falling speeds in rpm, each at least "
                f"{APART:g} times the next, for example 60,40,30,20,15,9.6,4.8"
            )

    @property
    def speeds(self) -> tuple[float, ...]:
        """rpm, as named, fastest first. Raises UsageError when one is no speed."""
        return speeds_of(self.speeds_rpm)

    @property
    def run_at(self) -> tuple[float, ...]:
        """rpm, as run."""
        return tuple(DETUNE * speed for speed in self.speeds)

    @property
    def waves(self) -> tuple[Triangle, ...]:
        """One for each speed. Every second one begins backwards: between two speeds the motor turns round, so that no
        stroke holds both.
        """
        amplitude = self.amplitude_deg * DEG
        signs = itertools.cycle((1.0, -1.0))
        return tuple(self._wave(sign * amplitude, speed) for sign, speed in zip(signs, self.run_at, strict=False))

    def _wave(self, amplitude: float, speed_rpm: float) -> Triangle:
        frequency = speed_rpm * RPM / abs(4.0 * amplitude)
        return Triangle(amplitude, frequency, max(self.cycles, math.ceil(self.least * frequency)))

    def envelope(self, setting: Setting) -> Envelope:
        """All triangles have the same travel; the first is the fastest."""
        waves = self.waves
        duration = sum(wave.duration + self.settle for wave in waves) + self.settle
        return Envelope(duration, self.amplitude_deg * DEG, abs(waves[0].speed), setting.control.torque_limit)

    def remarks(self, setting: Setting) -> list[str]:
        """Of strokes too short for a figure, which they are alike at every speed."""
        return too_short(replace(self.waves[0], cycles=sum(wave.cycles for wave in self.waves)))

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        told = {"speeds_rpm": [round(speed, 6) for speed in self.run_at], "tolerance": self.tolerance}
        return {"output_locked": False, "tau_ext": 0.0, **told}

    def steps(self, setting: Setting) -> Steps:
        """One triangle after the other under one and the same loop."""
        pid = Pid(setting.control, setting.period)
        sample = yield Torque(0.0)
        home, begin = sample.theta_m, self.settle
        for wave, speed in zip(self.waves, self.run_at, strict=True):
            setting.note(f"triangle at {speed:.4g} rpm from t = {begin:.3f} s")
            while sample.t < begin + wave.duration + self.settle:
                offset, omega_ref = wave.at(sample.t - begin)
                tau = pid.step(home + offset, omega_ref, sample.theta_m, sample.omega_m)
                sample = yield Torque(tau, home + offset, omega_ref)
            begin += wave.duration + self.settle
