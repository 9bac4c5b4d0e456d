"""An encoder that loses or gains counts, and reads wrong from then on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

LOAD, MOTOR = 0.0, 1.0  # of the first shape parameter: the encoder that lost them once, at an instant
GONE, FURTHEST, TURNED = 2.0, 3.0, 4.0  # again and again: with the way gone, the furthest from the start, the turning
FORTH, BACK = 5.0, 6.0  # with the way gone one way alone
WIDE = 1.5  # fastest over slowest: at one speed the way is the time
SEVERAL = 4  # runs: in one log the way is the time, and an angle


class MissedCounts(Effect):
    """Once: from the instant t_0 on the reading of one angle is off by a constant step; every run has its own instants.

    Again and again, too little at a time to be seen one by one: the reading falls behind in proportion to the way since
    the run began, at any speed or faster than ω_0, or one way alone. A disc closes upon itself, so that no scale of an
    encoder does that.
    Whatever is lost alike forth and back (TURNED at any speed) is the ratio's.

    The gear does not move: no torque goes with it. What a tooth does comes back at the same angle, lost counts do not.
    """

    name: ClassVar[str] = "missed_counts"
    in_short: ClassVar[str] = "permanent steps in one encoder"
    glosses: ClassVar[Mapping[str, str]] = {
        "steps": "steps found in all runs",
        "step_theta_l": "usual step of the load encoder's reading, at the output",
        "step_theta_m": "usual step of the motor encoder's reading",
        "lost_per_turn_gone": "what θ̃ runs away by while the output turns once, whichever way",
        "lost_per_turn_forth": "what θ̃ runs away by while the output turns once forth, and keeps while it turns back",
        "lost_per_turn_back": "what θ̃ runs away by while the output turns once back, and keeps while it turns forth",
        "lost_per_turn_further": "what θ̃ runs away by while the output gets a turn further from where the run began",
        "lost_per_turn": "what θ̃ runs away by while the output turns once, and comes back by while it turns back",
        "above_speed": "ω_0, speed of the motor below which nothing is lost, of a few that were tried",
    }
    source: ClassVar[str] = "usdigital"
    each_run: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("law", "at")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    SPEEDS: Final = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0)  # rad/s of the motor

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """What is lost again and again. The instant of a step is found by the row, not in shapes."""
        if reach.runs < SEVERAL or not reach.speeds_differ(WIDE) or not {"theta_m", "theta_l"} <= reach.has:
            return ()
        speeds = [w for w in self.SPEEDS if reach.slowest < w < reach.fastest]
        one_way = ((FORTH, 0.0), (BACK, 0.0)) if reach.both_ways else ()
        return ((GONE, 0.0), (FURTHEST, 0.0), *one_way, *((TURNED, w) for w in speeds))

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Chosen, not fitted: a speed, or an instant within the campaign."""
        return ((LOAD, BACK), (0.0, max(reach.duration, *self.SPEEDS)))

    def has_state(self) -> bool:
        """The way since the run began."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """0 before the instant, 1 after it; a filter of rate dt sees it where it falls between two rows. Or the way, in
        turns of the output."""
        law, at = shape
        if law not in (LOAD, MOTOR):
            return {Port.READS_THETA_L: -self._way(signals, law, at)[:, None]}
        after = np.clip((signals.t - at) / signals.dt + 0.5, 0.0, 1.0)[:, None]
        return {Port.READS_THETA_M if law == MOTOR else Port.READS_THETA_L: after}

    def plausible_together(self, fits: Sequence[Fit]) -> bool:
        """What is lost above one speed does not come back above another: such a pair is a reading that runs away
        between the two, as a zero does that is followed while the motor creeps."""
        lost = [float(f.coefficients[0]) for f in fits if f.shape[0] == TURNED]
        return not lost or abs(sum(lost)) > max(map(abs, lost)) / 2

    def _way(self, signals: Signals, law: float, above: float) -> Array:
        """Output turns since the run began, (n,), as the motor tells them."""
        step = np.diff(signals.theta_m, prepend=signals.theta_m[:1]) / (2.0 * np.pi * signals.ratio)
        step = np.where(np.abs(signals.omega_m) > above, step, 0.0)
        if law == GONE:  # noise of a reading goes forth and back, and is no way
            return np.asarray(np.cumsum(signals.way * step))
        if law in (FORTH, BACK):
            lossy = signals.way == (1.0 if law == FORTH else -1.0)
            return np.asarray(np.cumsum(np.where(lossy, signals.way * step, 0.0)))
        gone = np.cumsum(step)
        return np.asarray(np.maximum.accumulate(np.abs(gone)) if law == FURTHEST else gone)

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """What the reading is off by, at the shaft it belongs to; or by how much more after every turn of the output,
        and from which speed on."""
        law, at = fit.shape
        along = np.zeros(fit.covariance.shape[0])
        along[0] = 1.0
        step = {LOAD: "step_theta_l", MOTOR: "step_theta_m"}
        lost = {
            GONE: "lost_per_turn_gone",
            FURTHEST: "lost_per_turn_further",
            TURNED: "lost_per_turn",
            FORTH: "lost_per_turn_forth",
            BACK: "lost_per_turn_back",
        }
        size = parameter({**step, **lost}[law], fit.coefficients[0], fit.half_width(along), "rad")
        # neighbours of a speed are half and twice as high
        return (size, parameter("above_speed", at, at / 2, "rad/s")) if law in lost and at else (size,)
