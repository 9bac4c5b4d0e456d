"""How what a procedure asks for is put to a drive: as the torque of our own loop, or as its reference, the loop in the
drive being closed there.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, final

from rig.control.brake import brake
from rig.control.hold import hold
from rig.control.profile import Ramp
from rig.control.spin import ACCELERATION
from rig.core.procedure import Procedure, Setting, Steps
from rig.core.sample import NAN, Mode, Position, Sample, Setpoint, Torque, Velocity

REST = 0.1  # s the drive holds before its torque goes off


class Setpoints(ABC):
    """One of the drive's modes. `off` is what is recorded once nothing is asked for any more."""

    mode: ClassVar[Mode]
    off: ClassVar[float] = 0.0

    @abstractmethod
    def steps(self, procedure: Procedure, setting: Setting) -> Steps:
        """The procedure, in setpoints of this mode."""

    @abstractmethod
    def to_rest(self, procedure: Procedure, setting: Setting) -> Steps:
        """A controlled stop from wherever it is, in setpoints of this mode."""

    @abstractmethod
    def hold(self, setting: Setting) -> Steps:
        """To rest, and held there without end, in setpoints of this mode."""


@final
class AsTorque(Setpoints):
    """As it is asked for."""

    mode = Mode.TORQUE

    def steps(self, procedure: Procedure, setting: Setting) -> Steps:
        """Unchanged."""
        return procedure.steps(setting)

    def to_rest(self, procedure: Procedure, setting: Setting) -> Steps:
        """The procedure's own way to end, else the brake."""
        return procedure.to_rest(setting) or brake(setting)

    def hold(self, setting: Setting) -> Steps:
        """Under the position loop."""
        return hold(setting)


class AsReference(Setpoints):
    """The reference a torque serves is asked for; the torque itself is not. Where there is none, the motor is held."""

    @abstractmethod
    def asked(self, theta_ref: float, omega_ref: float, sample: Sample) -> Setpoint:
        """For a reference of rad and rad/s."""

    def steps(self, procedure: Procedure, setting: Setting) -> Steps:
        """What the procedure returns is passed on."""
        return (yield from self._follow(procedure.steps(setting)))

    def hold(self, setting: Setting) -> Steps:
        """The reference of the hold under the position loop."""
        return self._follow(hold(setting))

    def _follow(self, inner: Steps) -> Steps:
        next(inner)
        sample = yield Torque(0.0)  # asked of nobody: the first sample is not there yet
        theta_ref = sample.theta_m
        while True:
            try:
                torque = inner.send(sample)
            except StopIteration as end:
                return end.value
            if torque.theta_ref == torque.theta_ref:
                theta_ref = torque.theta_ref
            sample = yield self.asked(theta_ref, torque.omega_ref, sample)

    def to_rest(self, procedure: Procedure, setting: Setting) -> Steps:
        """Along a ramp from the speed it has, then held for a moment."""
        sample = yield Torque(0.0)
        ramp, home, begin = Ramp(sample.omega_m, 0.0, ACCELERATION), sample.theta_m, sample.t
        while (t := sample.t - begin) < ramp.duration + REST:
            offset, omega_ref = ramp.at(t)
            sample = yield self.asked(home + offset, omega_ref, sample)


@final
class AsVelocity(AsReference):
    """ω = ω_ref + (K_p/K_d)·(θ_ref − θ_m): our position loop around the drive's velocity loop, at the rate the bench
    file's gains have between them.
    """

    mode = Mode.VELOCITY

    def __init__(self, setting: Setting) -> None:
        gains = setting.control
        self._rate = gains.Kp / gains.Kd if gains.Kd > 0.0 else 0.0  # 1/s

    def asked(self, theta_ref: float, omega_ref: float, sample: Sample) -> Velocity:
        """rad/s."""
        return Velocity(omega_ref + self._rate * (theta_ref - sample.theta_m), theta_ref, omega_ref)


@final
class AsPosition(AsReference):
    """The reference itself."""

    mode = Mode.POSITION
    off = NAN

    def asked(self, theta_ref: float, omega_ref: float, sample: Sample) -> Position:
        """rad."""
        return Position(theta_ref, theta_ref, omega_ref)


def setpoints_of(mode: Mode, setting: Setting) -> Setpoints:
    """The member for `mode`."""
    match mode:
        case Mode.TORQUE:
            return AsTorque()
        case Mode.VELOCITY:
            return AsVelocity(setting)
        case Mode.POSITION:
            return AsPosition()
