"""What hangs on the output, by the torque sensor: at standstill first, then turning slowly both ways."""

from __future__ import annotations

import statistics
from collections.abc import Generator
from dataclasses import dataclass, field
from typing import ClassVar, NamedTuple

from rig.control.profile import Trapezoid
from rig.core.errors import NotReady
from rig.core.kinds import Regime
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Setpoint, Torque
from rig.core.units import TURN
from rig.procedures.one_turn import BLOCKS, DWELL, leg, one_turn, standard_error

STANDSTILL = 0.5  # s, 500 readings at 1 kHz


class Leg(NamedTuple):
    """Means of BLOCKS equal parts of the middle half of one turn, N·m."""

    shaft: list[float]  # torque sensor
    motor: list[float]  # as the drive reports it


class Weighing(NamedTuple):
    """What was measured, N·m at the torque sensor."""

    standstill: float  # before anything turned: what hangs there, less what friction on the load side holds
    torque: float  # mean of both directions: Coulomb friction cancels, what hangs there and the zero remain
    friction: float  # half the difference of the directions: friction on the load side
    error: float  # standard error of `torque`
    drag: float  # at the motor: half the difference of its torque, all that takes speed from a motor turning slowly
    sentence: str


@dataclass(frozen=True)
class Weigh(Procedure):
    """Read the torque sensor at rest, then over one slow motor turn forth and back: τ_ext = zero − mean of both.

    At rest the load's own friction may hold any part of a small weight; turning, it adds on one way what it takes off
    the other. Refused before anything turns when the reading at rest is farther than `band` from −τ_ext + zero.
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "weigh"
    regime: ClassVar[Regime] = Regime.AT_REST
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l", "tau_l")

    tau_ext: float = field(
        default=0.0, metadata={"signed": True}
    )  # N·m expected on the load, positive drives it forward
    zero: float = field(default=0.0, metadata={"signed": True})  # N·m, what the sensor shows with nothing on it
    band: float = 5.0  # N·m, load-side friction and the tolerance of the weight, at rest
    speed_rpm: float = 15.0  # of the motor

    @property
    def turn(self) -> Trapezoid:
        """One motor turn, so that the kinematic error averages out."""
        return one_turn(self.speed_rpm)

    def envelope(self, setting: Setting) -> Envelope:
        """One turn out and back."""
        duration = STANDSTILL + 2 * (self.turn.duration + DWELL)
        return Envelope(duration, TURN, self.turn.speed, setting.control.torque_limit)

    def conditions(self) -> dict[str, object]:
        """For the manifest."""
        return {"output_locked": False, "note": f"weighing, {self.tau_ext:g} N·m expected"}

    def steps(self, setting: Setting) -> Steps:
        """Returns a Weighing. Raises NotReady when the reading at rest is nowhere near what was expected."""
        standstill = yield from self._rest()
        expected = self.zero - self.tau_ext
        if not abs(standstill - expected) <= self.band:
            raise NotReady(
                f"at standstill the torque sensor shows {standstill:+.2f} N·m, expected {expected:+.2f} N·m within "
                f"{self.band:.2f} N·m for {self.tau_ext:+g} N·m on the output: is it there, and the right way round?"
            )
        forward = yield from self._leg(setting, +1)
        reverse = yield from self._leg(setting, -1)
        found = weighing(standstill, forward, reverse)
        if not self.tau_ext:
            return found
        beside = f"; {self.zero - found.torque:+.2f} N·m on the output by that, {self.tau_ext:+g} N·m expected"
        return found._replace(sentence=found.sentence + beside)

    def _rest(self) -> Generator[Setpoint, Sample, float]:
        sample = yield Torque(0.0)
        begin, readings = sample.t, [sample.tau_l]
        while sample.t - begin < STANDSTILL:
            sample = yield Torque(0.0)
            readings.append(sample.tau_l)
        return statistics.fmean(readings)

    def _leg(self, setting: Setting, direction: int) -> Generator[Setpoint, Sample, Leg]:
        """One turn under the position loop, read at constant speed."""
        blocks: list[list[Sample]] = [[] for _ in range(BLOCKS)]
        yield from leg(setting, self.turn, direction, lambda block, sample: blocks[block].append(sample))
        shaft = [statistics.fmean(s.tau_l for s in samples) for samples in blocks]
        return Leg(shaft, [statistics.fmean(s.tau_m for s in samples) for samples in blocks])


def weighing(standstill: float, forward: Leg, reverse: Leg) -> Weighing:
    """The two directions put together; `standstill` N·m at the torque sensor."""
    ahead, back = statistics.fmean(forward.shaft), statistics.fmean(reverse.shaft)
    drag = (statistics.fmean(forward.motor) - statistics.fmean(reverse.motor)) / 2
    torque, friction = (ahead + back) / 2, (ahead - back) / 2
    error = standard_error(forward.shaft, reverse.shaft) / 2
    sentence = (
        f"torque sensor {standstill:+.2f} N·m at standstill, {torque:+.3f} ± {2 * error:.3f} N·m over both directions, "
        f"friction {friction:.2f} N·m on the load side, {drag:.3f} N·m at the motor"
    )
    return Weighing(standstill, torque, friction, error, drag, sentence)
