"""Proof, before any loop is closed, that both encoders and the torque sensor mean what the bench file says."""

from __future__ import annotations

import math
import statistics
from collections.abc import Generator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from rig.control.profile import Trapezoid
from rig.core.errors import NotReady
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Setpoint
from rig.core.units import DEG, TURN
from rig.procedures.nudge import nudge, refuse_held
from rig.procedures.one_turn import BLOCKS, DWELL, leg, one_turn, standard_error

RATIO_TOLERANCE = 0.01  # of the declared ratio: a wrong scale is off by far more
TO_SPARE = 2.0  # s, for the nudge to end in
STEADY = 0.1  # of the nominal speed: a motor that nearly stops leaves any torque in the shaft
SIGMAS = 5.0  # a torque difference counts as seen beyond this many standard errors


class Proof(NamedTuple):
    """What was measured."""

    ratio: float  # motor turns per load turn over one wave-generator turn, both ways
    breakaway: float  # N·m that set the motor moving
    shaft_torque_difference: float  # N·m, forward minus reverse; NaN without a sensor
    shaft_torque_error: float  # N·m, standard error of it
    sentence: str


class Leg(NamedTuple):
    """One turn in one direction."""

    motor: float  # rad
    load: float  # rad
    shaft_torque: tuple[float, ...]  # N·m, means of BLOCKS equal parts of the middle half
    slowest: float  # lowest speed there over the nominal one: below 0 it went backwards


@dataclass(frozen=True)
class SignAndScale(Procedure):
    """A nudge of open-loop torque, then one slow wave-generator turn forth and back (7.2° of output).

    One whole turn, because over less the kinematic error itself bends the ratio by more than the 1 % looked for.
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "sign-and-scale"
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    closes_loop: ClassVar[bool] = False  # not before it is proven
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l")

    nudge_share: float = 0.4  # of the drive's torque limit, most the open-loop nudge may reach
    nudge_rate: float = 1.0  # N·m/s, of the nudge, until the motor moves
    nudge_deg: float = 5.0  # deg of the motor that count as moved
    speed_rpm: float = 15.0  # of the motor, for the turn

    @property
    def turn(self) -> Trapezoid:
        """One motor turn."""
        return one_turn(self.speed_rpm)

    def envelope(self, setting: Setting) -> Envelope:
        """The load need not follow: whether it does is the question."""
        limit = setting.control.torque_limit
        nudge = self.nudge_share * limit / self.nudge_rate
        torque = max(1.0, self.nudge_share) * limit  # beyond the limit it is refused
        duration = nudge + 2 * (self.turn.duration + DWELL) + TO_SPARE
        return Envelope(duration, 1.5 * TURN, self.turn.speed, torque, coupled=False)

    def conditions(self) -> dict[str, object]:
        """For the manifest."""
        return {"output_locked": False, "note": "sign-and-scale proof"}

    def steps(self, setting: Setting) -> Steps:
        """Returns a Proof. Raises NotReady, with what was measured, when the rig is not what the bench file says."""
        limit = self.nudge_share * setting.control.torque_limit
        # before a whole turn could wind up a gear whose output somebody has locked
        breakaway = yield from nudge(setting, limit, self.nudge_rate, self.nudge_deg)
        forward = yield from self._leg(setting, +1)
        reverse = yield from self._leg(setting, -1)
        return judge(forward, reverse, breakaway, setting)

    def _leg(self, setting: Setting, direction: int) -> Generator[Setpoint, Sample, Leg]:
        """One turn under the position loop; the shaft torque is averaged in the middle half, at constant speed."""
        move, slowest = self.turn, 1.0
        torques: list[list[float]] = [[] for _ in range(BLOCKS)]

        def take(block: int, sample: Sample) -> None:
            nonlocal slowest
            torques[block].append(sample.tau_l)
            slowest = min(slowest, direction * sample.omega_m / move.speed)

        first, last = yield from leg(setting, move, direction, take)
        means = tuple(statistics.fmean(part) for part in torques)
        return Leg(last.theta_m - first.theta_m, last.theta_l - first.theta_l, means, slowest)


def judge(forward: Leg, reverse: Leg, breakaway: float, setting: Setting) -> Proof:
    """Ratio, directions and torque-sensor sign against the bench file. Raises NotReady with the measured numbers."""
    motor, load = forward.motor - reverse.motor, forward.load - reverse.load
    refuse_held(motor, load, setting.ratio)
    ratio = motor / load
    if ratio < 0:
        raise NotReady(
            f"the load encoder turned {load / DEG:+.2f}° while the motor turned {motor / DEG:+.1f}° "
            f"(ratio {ratio:.2f}), expected {motor / setting.ratio / DEG:+.2f}°: flip one encoder in the bench file"
        )
    if abs(ratio / setting.ratio - 1) > RATIO_TOLERANCE:
        raise NotReady(
            f"measured ratio {ratio:.3f}, the bench file says {setting.ratio:g} (1 % allowed): "
            "check N and both counts_per_turn"
        )
    difference = statistics.fmean(forward.shaft_torque) - statistics.fmean(reverse.shaft_torque)
    error = standard_error(forward.shaft_torque, reverse.shaft_torque)
    steady = min(forward.slowest, reverse.slowest) > STEADY
    if steady and difference < -SIGMAS * error:
        raise NotReady(
            f"shaft torque is {difference:+.2f} ± {2 * error:.2f} N·m forward against reverse, expected positive: "
            "the torque sensor has the wrong sign"
        )
    seen = "" if difference > SIGMAS * error else " (too small to prove the torque sensor's sign)"
    if not steady:
        seen = " (its sign was not judged: the motor turned unevenly; hdrig tune)"
    if math.isnan(difference):
        seen = " (no torque sensor)"
    sentence = (
        f"ratio {ratio:.3f} (declared {setting.ratio:g}), both encoders positive, breakaway {breakaway:.2f} N·m, "
        f"shaft torque forward minus reverse {difference:+.3f} ± {2 * error:.3f} N·m{seen}"
    )
    return Proof(ratio, breakaway, difference, error, sentence)
