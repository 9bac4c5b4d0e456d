"""Both angles in degrees where rad are expected: they keep their ratio, so nothing else in them says so."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.findings.result import Array
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


TURNS: Final = 3.5  # of the motor at least, were it in degrees: of fewer an output's orders make half as well
ORDERS: Final = 6  # of a turn that are asked for
BENDS: Final = 4  # a trend, and what changes with the way
WAVES: Final = 20_000  # rows that are enough for them
MOST: Final = 0.9  # of θ̃, which comes again every turn in degrees
LITTLE: Final = 0.01  # of it, which does so every turn in rad: of any gear a kinematic error of some per cent is in it


def come_again_in_degrees(theta_m: Array, theta_l: Array, ratio: float) -> str | None:
    """Why both angles (n,) seem to be in degrees, by the waves of θ̃ = θ_m/N − θ_l: those of every gear come again with
    the motor's turn. None where they do not, or too few turns are there to tell."""
    if np.ptp(theta_m) / 360.0 < TURNS:
        return None
    if abs(np.ptp(theta_l) * ratio / np.ptp(theta_m) - 1) > UNLIKE:  # one of them alone
        return None
    few = slice(None, None, max(1, theta_m.size // WAVES))
    theta, error = theta_m[few], theta_m[few] / ratio - theta_l[few]
    known = np.isfinite(theta) & np.isfinite(error)
    theta, error = theta[known], error[known]
    if theta.size < 10 * ORDERS:
        return None
    bare = _left(theta, error, 0.0)
    as_read, in_degrees = (1.0 - _left(theta, error, by) / max(bare, 1e-300) for by in (1.0, 1.0 / DEGREES))
    if not (in_degrees > MOST and as_read < LITTLE):
        return None
    return (
        f"{100 * in_degrees:.0f} % of θ̃ comes again once in {DEGREES:.1f} turns of θ_m as it stands, next to nothing "
        "every turn: both angles seem to be in degrees, expected rad"
    )


def _left(theta: Array, error: Array, by: float) -> float:
    """Sum of squares that a trend, and with `by` above zero waves of `by`·θ, leave."""
    x = (theta - theta.mean()) / max(float(np.ptp(theta)), 1e-300)
    columns = [x**k for k in range(BENDS)] + [np.sign(np.gradient(theta))]
    if by:
        columns += [f(n * by * theta) for n in range(1, ORDERS + 1) for f in (np.cos, np.sin)]
    z = np.stack(columns, 1)
    return float(np.sum((error - z @ np.linalg.lstsq(z, error, rcond=None)[0]) ** 2))


@dataclass(frozen=True)
class Turning:
    """What tells the unit of a motor's angle: its smallest step and one declared count (rad, 0 where there is none),
    its mean speed and the declared one (rpm; None where no time tells it, 0 where nobody says it), the gear's ratio."""

    step: float
    count: float
    rpm: float | None
    said_rpm: float
    ratio: float
    waves: str | None = None  # what the waves of both angles say of it, where no count is declared

    @property
    def in_degrees(self) -> str | None:
        """Why it seems to be in degrees: by the smallest step, by the declared speed, by what no motor reaches,
        by the waves."""
        if self.count and abs(self.step / self.count / DEGREES - 1) < STEP:
            return (
                f"θ_m moves in steps of {self.step:.4g} rad, {self.step / self.count:.1f} times the declared count of "
                f"{self.count:.3g} rad: both angles seem to be in degrees, expected rad"
            )
        if self.rpm is None:
            return self.waves
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
        return self.waves


def turning_of(run: Source, motion: Motion) -> Turning:
    """Of a run as it was read."""
    encoders = run.manifest.get("encoders")
    counts = stated(encoders.get("motor_counts_per_rev"), 0.0) if isinstance(encoders, dict) else 0.0
    theta_m, t = motion.theta_m[:ROWS], None if motion.t is None else motion.t[:ROWS]
    theta_l = None if motion.theta_l is None else motion.theta_l[:ROWS]
    way = float(np.sum(np.abs(np.diff(theta_m))))
    lasted = 0.0 if t is None else float(t[-1] - t[0])
    return Turning(
        step=smallest_step(theta_m),
        count=TURN / counts if counts > 0 else 0.0,
        rpm=way / lasted / RPM if lasted > 0 else None,
        said_rpm=abs(stated(run.conditions.get("speed_rpm"), 0.0)),
        ratio=run.ratio,
        waves=None if counts > 0 or theta_l is None else come_again_in_degrees(theta_m, theta_l, run.ratio),
    )
