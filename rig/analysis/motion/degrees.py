"""Both angles in degrees where rad are expected: they keep their ratio, so nothing else in them says so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.motion.smallest_step import smallest_step
from rig.analysis.motion.source import Motion, Source
from rig.core.numbers import stated
from rig.core.units import RPM, TURN

DEGREES: Final = 360 / TURN
STEP: Final = 2e-3  # relative, of a step that is a count in degrees: 57 counts are 5e-3 off
SPEED: Final = 0.05  # the same of a speed: one held by a constant torque is a few per cent off
UNLIKE: Final = 0.1  # how far the ratio must be from 57.3 before a speed says anything: it might be the output's
FASTEST: Final = 15_000.0  # rpm of the motor, mean: strain-wave gears end at 14 000, and 300 rpm in degrees are 17 000
ROWS: Final = 200_000  # looked at, those first: a unit is the same all along, and a run may have a day of rows


@dataclass(frozen=True)
class Turning:
    """What tells the unit of a motor's angle: its smallest step and one declared count (rad, 0 where there is none),
    its mean speed and the declared one (rpm; None where no time tells it, 0 where nobody says it), the gear's ratio."""

    step: float
    count: float
    rpm: float | None
    said_rpm: float
    ratio: float

    @property
    def in_degrees(self) -> str | None:
        """Why it seems to be in degrees: by the smallest step, by the declared speed, by what no motor reaches."""
        if self.count and abs(self.step / self.count / DEGREES - 1) < STEP:
            return (
                f"θ_m moves in steps of {self.step:.4g} rad, {self.step / self.count:.1f} times the declared count of "
                f"{self.count:.3g} rad: both angles seem to be in degrees, expected rad"
            )
        if self.rpm is None:
            return None
        own = abs(self.ratio / DEGREES - 1) > UNLIKE
        if own and self.said_rpm and abs(self.rpm / self.said_rpm / DEGREES - 1) < SPEED:
            return (
                f"the motor turns at {self.rpm:.4g} rpm, {self.rpm / self.said_rpm:.1f} times the declared speed_rpm "
                f"{self.said_rpm:g}: both angles seem to be in degrees, expected rad"
            )
        if self.rpm > FASTEST:
            return (
                f"the motor turns at {self.rpm:.4g} rpm, expected below {FASTEST:.0f} rpm: its angle seems to be in "
                "degrees or counts, expected rad"
            )
        return None


def turning_of(run: Source, motion: Motion) -> Turning:
    """Of a run as it was read."""
    encoders = run.manifest.get("encoders")
    counts = stated(encoders.get("motor_counts_per_rev"), 0.0) if isinstance(encoders, dict) else 0.0
    theta_m, t = motion.theta_m[:ROWS], None if motion.t is None else motion.t[:ROWS]
    way = float(np.sum(np.abs(np.diff(theta_m))))
    lasted = 0.0 if t is None else float(t[-1] - t[0])
    return Turning(
        step=smallest_step(theta_m),
        count=TURN / counts if counts > 0 else 0.0,
        rpm=way / lasted / RPM if lasted > 0 else None,
        said_rpm=abs(stated(run.conditions.get("speed_rpm"), 0.0)),
        ratio=run.ratio,
    )
