"""Stiffness that changes over a turn of the wave generator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave

# of the first shape parameter, several orders at once: 1, 2 and 4, as a wave generator with two lobes has them, those
# of a narrow sector that either lobe passes, or all of a spring that is soft where one lobe is and not the other
TOGETHER, SECTOR, UNEVEN = 0.0, -1.0, -2.0
MOTOR, OUTPUT = 0.0, 1.0  # of the third shape parameter: whose angle it is
REACTION: Final = {MOTOR: Port.MOTOR_TORQUE, OUTPUT: Port.LOAD_TORQUE}


class AngleDependentStiffness(Effect):
    """1/K gains κ/K·cos(k·θ_m + φ), of one k or several: the wind-up gains T·κ/K·cos …, the motor is resisted by
    ½·φ²·dK/dθ_m.

    That reaction, −½·T²·d(1/K)/dθ_m, is 0.01 N·m with κ = 5 % at 40 N·m. Where the angle at which the stiffness changes
    is not that of the spring's own energy it is absent: the data choose.
    """

    name: ClassVar[str] = "angle_dependent_stiffness"
    in_short: ClassVar[str] = "stiffness modulated by angle"
    glosses: ClassVar[Mapping[str, str]] = {
        **waved("kappa_order_{n}", "κ, the compliance's change over its mean, {n} times a motor turn", "{n}·θ_m"),
        **waved(
            "kappa_order_{n}_of_output", "κ, the compliance's change over its mean, {n} times an output turn", "{n}·θ_l"
        ),
    }
    source: ClassVar[str] = "ghorbel2001"
    in_the_spring: ClassVar[bool] = True
    backbone: ClassVar[bool] = True  # over a stroke the output's angle goes with the time since it began
    shape_names: ClassVar[tuple[str, ...]] = ("order", "reaction", "side")
    loose: ClassVar[tuple[bool, ...]] = (False, False, False)
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0)
    SEVERAL: Final = {
        TOGETHER: (1.0, 2.0, 4.0),
        SECTOR: (2.0, 4.0, 6.0, 8.0),
        UNEVEN: (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0),
    }
    OF_OUTPUT: Final = (1.0, 2.0)
    TURNS: Final = 0.5  # of the output, least travel: an order 1 has shown both its ends then

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Low orders of the wave generator, and of the output where it turns far enough."""
        of_motor = [(k, reaction, MOTOR) for k in (*self.ORDERS, *self.SEVERAL) for reaction in (1.0, 0.0)]
        orders = self.OF_OUTPUT if reach.load_turns >= self.TURNS else ()
        return (*of_motor, *((k, reaction, OUTPUT) for k in orders for reaction in (1.0, 0.0)))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """T times cosine and sine of each order, and what they do to the shaft whose angle it is."""
        _, reaction, side = shape
        angle, torque = signals.theta_m if side == MOTOR else signals.theta_l, signals.torque[:, None]
        orders = self._orders(shape)
        waves = [wave(k * angle) for k in orders]
        back = [(reaction * k / 2) * w[:, ::-1] * (1.0, -1.0) for k, w in zip(orders, waves, strict=True)]
        return {Port.WIND_UP: np.hstack(waves) * torque, REACTION[side]: np.hstack(back) * torque**2}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude of the compliance, and phase, of each order, the largest first."""
        of = "" if fit.shape[2] == MOTOR else "_of_output"
        each = [
            harmonic(fit, f"kappa_order_{k:g}{of}", "1", first=2 * i, scale=fit.known.K)
            for i, k in enumerate(self._orders(fit.shape))
        ]
        return tuple(
            p for amplitude_and_phase in sorted(each, key=_amplitude, reverse=True) for p in amplitude_and_phase
        )

    def plausible(self, fit: Fit) -> bool:
        """A compliance above zero everywhere: one that turns round with the angle is no spring's."""
        waves = np.hypot(fit.coefficients[0::2], fit.coefficients[1::2])
        return bool((waves * fit.known.K < 1.0).all())

    def _orders(self, shape: Shape) -> tuple[float, ...]:
        return self.SEVERAL.get(shape[0], (shape[0],))


def _amplitude(amplitude_and_phase: tuple[Parameter, Parameter]) -> float:
    return amplitude_and_phase[0].value
