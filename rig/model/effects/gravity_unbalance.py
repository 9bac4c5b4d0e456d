"""Torque once per output turn: the load's centre of mass is off its axis, and the axis is not upright."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.output_orders import SWING

TORQUES: Final = frozenset({"tau_m", "tau_l"})  # one of which feels it
NONE, THIRD = 0.0, 3.0  # of the second shape parameter: the overtone


class GravityUnbalance(Effect):
    """The load is resisted by m·g·e·cos(θ_l + φ); by a second wave where a cable or a joint pulls twice a turn

    A mass that has play on its arm, or that a strap holds, flattens the wave: then it has its third overtone as well.
    """

    name: ClassVar[str] = "gravity_unbalance"
    in_short: ClassVar[str] = "torque once per output turn"
    glosses: ClassVar[Mapping[str, str]] = {
        **waved("unbalance", "m·g·e, the load's torque once an output turn", "θ_l"),
        **waved("twice_a_turn", "the load's torque twice an output turn", "2·θ_l"),
        **waved("three_times_a_turn", "the load's torque three times an output turn", "3·θ_l"),
    }
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order", "overtone")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    MOST: Final = 0.5  # of the wave, its overtone: a square wave has a third
    TWICE: Final = 0.65  # of what pulls once, what pulls twice: a mass that swings on a lever had a half (exam 75)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """A weight on a joint that swings by ten degrees is what most of its torque is; less than a sixth of an output
        turn does not tell one wave from two, less than a half has no overtones; in angles alone a weight is a runout.
        """
        if reach.load_turns < SWING or not reach.has & TORQUES:
            return ()
        twice = ((2.0, NONE),) if reach.load_turns > 1 / 6 else ()
        flattened = ((1.0, THIRD),) if reach.load_turns > 1 / 2 else ()
        return ((1.0, NONE), *twice, *flattened)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the load angle, and of the overtone's."""
        waves = [shape[0] * signals.theta_l, *([shape[1] * signals.theta_l] if shape[1] else [])]
        return {Port.LOAD_TORQUE: np.stack([f(x) for x in waves for f in (np.cos, np.sin)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """m·g·e and phase; of a second wave or an overtone amplitude and phase."""
        wave = harmonic(fit, "unbalance" if fit.shape[0] == 1.0 else "twice_a_turn", "N·m")
        return (*wave, *harmonic(fit, "three_times_a_turn", "N·m", first=2)) if fit.shape[1] else wave

    def plausible(self, fit: Fit) -> bool:
        """An overtone is smaller than what it is one of."""
        if not fit.shape[1]:
            return True
        wave, overtone = np.hypot(*fit.coefficients[:2]), np.hypot(*fit.coefficients[2:])
        return bool(overtone < self.MOST * wave)

    def plausible_together(self, fits: Sequence[Fit]) -> bool:
        """What pulls twice a turn pulls less than the weight that pulls once: else it is a cable, or a stop, that holds
        the load over some of its turn."""
        sizes = {order: [float(np.hypot(*f.coefficients[:2])) for f in fits if f.shape[0] == order] for order in (1, 2)}
        return not sizes[2] or sum(sizes[2]) < self.TWICE * sum(sizes[1])
