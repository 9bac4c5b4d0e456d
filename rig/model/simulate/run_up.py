"""A torque switched on at rest: whether the gear breaks away, how quickly it runs up, and how sure that is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.core.units import TURN
from rig.model.gear import Gear
from rig.model.simulate.sweep import each_under_torque
from rig.model.simulate.waveform import Array

STEP = 0.01  # s between the times kept: a turn at 600 rpm is ten of them
LAST = 0.2  # of the time: the speed it ends at is the mean over it
REACHED = 0.95  # of that speed: it has run up


@dataclass(frozen=True)
class RunUp:
    """Every gear under one torque from rest: `t` (n,) s, angle of each motor (gears, n) rad."""

    t: Array
    theta_m: Array

    @property
    def moved(self) -> Array:
        """(gears,) of the turns of the wave generator made in all."""
        return np.asarray(np.abs(self.theta_m[:, -1] - self.theta_m[:, 0]) / TURN)

    @property
    def speed(self) -> Array:
        """(gears,) rad/s of the motor at the end, mean over LAST of the time."""
        first = int((1.0 - LAST) * (self.t.size - 1))
        return np.asarray((self.theta_m[:, -1] - self.theta_m[:, first]) / (self.t[-1] - self.t[first]))

    @property
    def turning(self) -> Array:
        """(gears,) bool: it broke away and did not stop again."""
        return np.asarray(np.abs(self.speed) * LAST * self.t[-1] > TURN)

    @property
    def time(self) -> Array:
        """(gears,) s until the speed came to REACHED of the last; NaN where it does not turn.

        From where the straight line the angle ends on meets the time axis: for a speed that nears its end as
        1 − e^(−t/T) that is T, and 0.95 of it is reached at 3·T. The ripple of a turn is not in it.
        """
        intercept = self.t[-1] * (1.0 - 0.5 * LAST) - self._middle() / np.where(self.turning, self.speed, np.nan)
        return np.asarray(-np.log(1.0 - REACHED) * np.maximum(intercept, 0.0))

    def _middle(self) -> Array:
        """Way of each motor to the middle of the last part, rad."""
        first = int((1.0 - LAST) * (self.t.size - 1))
        return np.asarray(self.theta_m[:, first:].mean(axis=1) - self.theta_m[:, 0])


def run_up(gears: Sequence[Gear], tau: float, seconds: float, tau_ext: float = 0.0) -> RunUp:
    """Every gear at rest, its spring relaxed, under `tau` N·m for `seconds`      [ghorbel2001, Eqs. 6-7]"""
    t = np.linspace(0.0, seconds, max(round(seconds / STEP), 10) + 1)
    return RunUp(t, each_under_torque(gears, t, np.full(t.size, tau), tau_ext).theta_m)
