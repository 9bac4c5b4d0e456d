"""A motor pushed by one constant torque: what the constant-torque run and the sentinel have in common."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import Any

from rig.control.spin import (
    hold_duration,
    hold_speed,
    hold_travel,
    slow_down,
    slow_down_duration,
    slow_down_travel,
)
from rig.core.errors import NotReady, UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Torque
from rig.core.units import RPM, TURN

AVERAGE = 5.0  # s of torque under the loop
FOUND = 0.004  # 1 σ of the torque found, relative: friction that wanders 1 % with 0.3 s, over AVERAGE
SHORT = 0.5  # s of it where the torque is given
MARGIN = 1.15  # constant torque gives the asked speed to within this factor: friction wanders, the drive rounds
STALL = 3.0  # times the duration of a turn without a turn: the motor is coming to a stand
DRIFT = 0.05  # of the speed, first to last third: what is told as a drift


@dataclass(frozen=True)
class Found:
    """What a run at constant torque did: the run's finding."""

    torque: float  # N·m
    begin: float  # s, where the measured part begins
    end: float  # s
    revolutions: int
    speed_rpm: float  # mean of the measured part, signed
    drift: float  # last third of the turns against the first, relative

    @property
    def sentence(self) -> str:
        """For the operator and events.jsonl."""
        word = f"; it drifted by {100 * self.drift:+.1f} % on the way" if abs(self.drift) > DRIFT else ""
        return (
            f"measured from t = {self.begin:.3f} to {self.end:.3f} s at a constant {self.torque:.4f} N·m: "
            f"{self.revolutions} turns at a mean of {self.speed_rpm:.1f} rpm{word}"
        )


@dataclass(frozen=True)
class OpenLoop:
    """Up to the speed under the loop, the torque that held it given open loop, down along a ramp."""

    speed_rpm: float
    revolutions: int
    settle: float  # s
    torque: float  # N·m; 0: the mean of what the loop gave

    def __post_init__(self) -> None:
        if self.speed_rpm == 0.0:
            raise UsageError("speed_rpm = 0: expected a speed of either sign, for example 310 or -310 rpm")
        if self.torque * self.speed_rpm < 0.0:
            raise UsageError(
                f"torque = {self.torque:g} N·m against speed_rpm = {self.speed_rpm:g} rpm: expected the sign of the "
                "speed, or 0 to have it found"
            )

    @property
    def omega(self) -> float:
        """rad/s, signed."""
        return self.speed_rpm * RPM

    @property
    def average(self) -> float:
        """s under the loop at speed."""
        return SHORT if self.torque else AVERAGE

    @property
    def longest(self) -> float:
        """s the measured part may take."""
        return MARGIN * self.revolutions * TURN / abs(self.omega)

    def settled(self, setting: Setting) -> float:
        """rad/s, at least 0, that the torque drives the motor to in the time it acts; the asked speed where the torque
        is found from it.
        """
        if not self.torque:
            return abs(self.omega)
        return setting.drivetrain.speed_after(abs(self.torque), self.settle + self.longest, abs(self.omega))

    def envelope(self, setting: Setting) -> Envelope:
        """With the margin in speed on all that is not held by the loop. Raises NotReady for a torque with which the
        motor comes to a stand by the friction declared.
        """
        self._refuse_too_little(setting)
        omega, settled = abs(self.omega), self.settled(setting)
        fast = MARGIN * max(omega, settled)
        travel = hold_travel(omega, self.average) + fast * self.settle + (self.revolutions + 1) * TURN
        duration = hold_duration(omega, self.average) + self.settle + self.longest + slow_down_duration(fast)
        return Envelope(
            duration,
            travel + slow_down_travel(fast),
            fast,
            max(setting.control.torque_limit, abs(self.torque)),
            reserve=self.reserve(setting),
        )

    def _refuse_too_little(self, setting: Setting) -> None:
        tau_c = setting.drivetrain.tau_c
        if self.torque and abs(self.torque) <= tau_c and not self.settled(setting):
            raise NotReady(
                f"torque = {self.torque:g} N·m lets the motor come to a stand: the declared friction alone, "
                f"gear.tau_c, takes {tau_c:g} N·m; expected more than that, or torque = 0 to have it found at "
                f"{self.speed_rpm:g} rpm "
                "(hdrig run friction measures gear.tau_c)"
            )

    def reserve(self, setting: Setting) -> str:
        """What of its speed was not asked for, in words."""
        share, settled = f"{100 * (MARGIN - 1):.0f} %", self.settled(setting)
        if settled > abs(self.omega):
            return f"{self.driven(setting)}, and {share} that it may miss it by"
        return f"speed_rpm = {self.speed_rpm:g}, and {share} that a torque nothing corrects may miss it by"

    def driven(self, setting: Setting) -> str:
        """Where a torque that is given takes the motor, in words."""
        tau_c = setting.drivetrain.tau_c
        friction = f"gear.tau_c = {tau_c:g} N·m" if tau_c else "no gear.tau_c: hdrig run friction measures it"
        return (
            f"torque = {self.torque:g} N·m takes the motor to {self.settled(setting) / RPM:.0f} rpm by the declared "
            f"inertia, damping and friction ({friction})"
        )

    def remarks(self, setting: Setting) -> list[str]:
        """Of a torque that is given."""
        return [f"open loop   {self.driven(setting)}, held at {self.speed_rpm:g} rpm before"] if self.torque else []

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": False, "tau_ext": 0.0, "speed_rpm": self.speed_rpm, "settle_s": self.settle}

    def steps(self, setting: Setting) -> Steps:
        """The run; its finding is a `Found`."""
        held = yield from hold_speed(setting, self.omega, self.average)
        tau = self.torque or held
        setting.note(f"from here on a constant {tau:.4f} N·m; the loop had needed {held:.4f} N·m for the speed")
        sample = yield Torque(tau)
        begin = sample.t + self.settle
        while sample.t < begin:
            sample = yield Torque(tau)
        marks = yield from self._turns(tau, sample)
        found = self._found(tau, marks)
        setting.note(found.sentence)
        sample = yield Torque(tau)
        yield from slow_down(setting, sample, tau)
        return found

    def _turns(self, tau: float, sample: Sample) -> Generator[Torque, Sample, list[float]]:
        """The times [s] at which turns were complete. Raises NotReady when the motor comes to a stand."""
        start, way, marks = sample.theta_m, math.copysign(1.0, self.omega), [sample.t]
        patience, latest = STALL * TURN / abs(self.omega), sample.t + self.longest
        while len(marks) <= self.revolutions and sample.t < latest:
            if way * (sample.theta_m - start) >= TURN * len(marks):
                marks.append(sample.t)
            if sample.t - marks[-1] > patience:
                raise NotReady(
                    f"the motor did not keep turning at a constant {tau:.4f} N·m: no whole turn for {patience:.1f} s "
                    f"at an expected {self.speed_rpm:g} rpm; friction has risen, or falls with speed here: go faster"
                )
            sample = yield Torque(tau)
        return marks

    def _found(self, tau: float, marks: list[float]) -> Found:
        turns, way = len(marks) - 1, math.copysign(1.0, self.omega)
        third = max(turns // 3, 1)
        early, late = (marks[third] - marks[0], marks[-1] - marks[-1 - third]) if turns else (1.0, 1.0)
        span = max(marks[-1] - marks[0], 1e-9)
        return Found(tau, marks[0], marks[-1], turns, way * turns * 60.0 / span, early / late - 1.0)


class Pushed(Procedure):
    """A procedure that is an `OpenLoop` and no more; its parameters are the members' own, as their defaults differ."""

    speed_rpm: float  # of the motor, signed
    revolutions: int
    settle: float  # s
    torque: float  # N·m, sign of the speed; 0: find it

    def __post_init__(self) -> None:
        _ = self.plan  # refuses what cannot be meant

    @property
    def plan(self) -> OpenLoop:
        """The same in SI."""
        return OpenLoop(self.speed_rpm, self.revolutions, self.settle, self.torque)

    def envelope(self, setting: Setting) -> Envelope:
        """The speed with what it may overshoot; the torque is what the loop may give while it holds the speed."""
        return self.plan.envelope(setting)

    def remarks(self, setting: Setting) -> list[str]:
        """Where a torque that is given takes the motor."""
        return self.plan.remarks(setting)

    def conditions(self) -> dict[str, Any]:
        """For the manifest; `settle_s` tells the analysis what to leave out."""
        return self.plan.conditions()

    def steps(self, setting: Setting) -> Steps:
        """Up, held, let run, down."""
        return self.plan.steps(setting)
