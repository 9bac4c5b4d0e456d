"""Short torque steps both ways from rest: what inertia and friction the position loop has to deal with.

A slow nudge comes first: a step against a locked output would wind the gear up beyond its limits, guard or not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from rig.core.kinds import Regime
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Torque
from rig.core.units import DEG, TURN
from rig.procedures.nudge import REST, nudge
from rig.procedures.stiffness_lock import OVERSHOOT_BY

NUDGE_RATE = 1.0  # N·m/s
NUDGE_DEG = 5.0  # deg of the motor that count as moved: 0.1° of a locked output, 12.5 N·m at 7160 N·m/rad
OVERSHOOT = 1.5  # of what is expected at the shaft: kinematic error, stick-slip, a nudge that runs on


@dataclass(frozen=True)
class StepTest(Procedure):
    """Torque on for a moment, then off until the motor rests; forward and reverse, `repeats` times.

    While on: J·ω̇ = τ − τ_f; while off: J·ω̇ = −τ_f. Two slopes, two unknowns, no closed loop.
    """

    name: ClassVar[str] = "other"
    label: ClassVar[str] = "step-test"
    regime: ClassVar[Regime] = Regime.LOSSES
    answers: ClassVar[bool] = True
    checks: ClassVar[bool] = True
    closes_loop: ClassVar[bool] = False  # no sign to prove: none can run away, and `tune` has no gains yet
    needs: ClassVar[tuple[str, ...]] = ("theta_m",)

    torque: float = 1.25  # N·m, well above breakaway
    on: float = 0.06  # s with torque
    off: float = 0.6  # s without, at most: the motor comes to rest
    repeats: int = 3  # each way

    def envelope(self, setting: Setting) -> Envelope:
        """By the declared inertias, damping and friction: each step starts from rest or against the motion."""
        duration = self.torque / NUDGE_RATE + REST + 2 * self.repeats * (self.on + self.off)
        speed = setting.drivetrain.step_speed(self.torque, self.on)
        travel = speed * (self.on + self.off) + TURN  # as if nothing slowed it down, and the nudge
        shaft, reserve = self.shaft_torque(setting), f"torque = {self.torque:g} N·m, on = {self.on:g} s"
        return Envelope(duration, travel, speed, self.torque, coupled=False, shaft_torque=shaft, reserve=reserve)

    def shaft_torque(self, setting: Setting) -> float:
        """N·m at the torque sensor at most: a step of a free output, or the nudge of a locked one."""
        step = setting.drivetrain.step_shaft_torque(self.torque, self.on + self.off)
        wound = setting.stiffness * NUDGE_DEG * DEG / setting.ratio
        return OVERSHOOT * max(step, wound) + OVERSHOOT_BY if wound > 0 else math.inf  # NaN: no stiffness declared

    def conditions(self) -> dict[str, object]:
        """For the manifest."""
        return {"output_locked": False, "note": f"torque steps of ±{self.torque:g} N·m"}

    def steps(self, setting: Setting) -> Steps:
        """Forward, reverse, forward … Raises NotReady when the nudge does not move motor and load."""
        yield from nudge(setting, self.torque, NUDGE_RATE, NUDGE_DEG)
        sample = yield Torque(0.0)
        for k in range(2 * self.repeats):
            begin, tau = sample.t, self.torque if k % 2 == 0 else -self.torque
            while (t := sample.t - begin) < self.on + self.off:
                sample = yield Torque(tau if t < self.on else 0.0)
