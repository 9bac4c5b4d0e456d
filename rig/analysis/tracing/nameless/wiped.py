"""Friction that is more where the motor has just turned back, or set out, and is worn off on the way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import Amount, Nameless, sum_of, when
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals

TURNED, SET_OUT = 0.0, 1.0  # of the first shape parameter: since when the way counts


class WipedGrease(Nameless):
    """The motor's friction is more by τ·e^{−s/d}, s being how far it has gone since it turned back, or since the run
    began as well: grease that lies in a ridge, and is pushed away      [lugt2013]

    Where runs are slow this is friction that falls with the speed; but it falls along the way of one that is not.
    """

    name: ClassVar[str] = "wiped_grease"
    in_short: ClassVar[str] = "friction wears off on the way"
    source: ClassVar[str] = "lugt2013"
    needs: ClassVar[frozenset[str]] = frozenset({"theta_m", "tau_m"})
    shape_names: ClassVar[tuple[str, ...]] = ("since", "d")
    loose: ClassVar[tuple[bool, ...]] = (False, True)
    WAYS: Final = (1.5, 4.0, 10.0, 25.0)  # rad of the motor
    SHORTEST: Final = 0.8  # rad: what builds up or fades over less is presliding's

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Ways, since the motor turned back where it does, and since a run began where there are several."""
        turned = when(reach.both_ways, *((TURNED, d) for d in self.WAYS))
        return (*turned, *when(reach.runs > 1, *((SET_OUT, d) for d in self.WAYS)))

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """From what is no presliding any more to some turns of the motor."""
        return ((TURNED, SET_OUT), (self.SHORTEST, 2.0 * self.WAYS[-1]))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        since, d = shape

        def gone(whole: Signals) -> tuple[Array, ...]:
            return (whole.once(f"gone since {since:g}", lambda: _gone(whole, since == SET_OUT)),)

        (s,) = signals.states(gone, since)
        return {Port.MOTOR_TORQUE: (signals.way * np.exp(-s / d))[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """At first."""
        return sum_of(fit, "where it turns back it is larger by", 1000, "mN·m")

    def plausible(self, fit: Fit) -> bool:
        """It wears off: what builds up is presliding."""
        return bool(fit.coefficients[0] > 0)


def _gone(s: Signals, from_the_start: bool) -> Array:
    """How far the motor has gone since it turned back, rad (n,); before it did for the first time, since the piece
    began, or farther than counts."""
    path = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(s.theta_m)))])
    moving = np.flatnonzero(s.way != 0)
    back = moving[1:][np.diff(s.way[moving]) != 0]  # the first rows of a new way
    since = np.searchsorted(back, np.arange(path.size), side="right") - 1
    begun = path[back][since] if back.size else np.zeros(path.size)
    return np.where(since >= 0, path - begun, path if from_the_start else np.inf)
