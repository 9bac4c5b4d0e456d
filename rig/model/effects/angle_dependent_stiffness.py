"""Stiffness that changes over a turn of the wave generator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave

MOTOR, OUTPUT = 0.0, 1.0  # of the third shape parameter: whose angle it is
REACTION: Final = {MOTOR: Port.MOTOR_TORQUE, OUTPUT: Port.LOAD_TORQUE}


class AngleDependentStiffness(Effect):
    """1/K gains κ/K·cos(k·θ_m + φ), k = 1, 2, 4: the wind-up gains T·κ/K·cos …, the motor is resisted by ½·φ²·dK/dθ_m

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
    backbone: ClassVar[bool] = True  # over a stroke the output's angle goes with the time since it began
    shape_names: ClassVar[tuple[str, ...]] = ("order", "reaction", "side")
    loose: ClassVar[tuple[bool, ...]] = (False, False, False)
    ORDERS: Final = (1.0, 2.0, 3.0, 4.0, 6.0)
    OF_OUTPUT: Final = (1.0, 2.0)
    TURNS: Final = 0.5  # of the output, least travel: an order 1 has shown both its ends then

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Low orders of the wave generator, and of the output where it turns far enough."""
        of_motor = [(k, reaction, MOTOR) for k in self.ORDERS for reaction in (1.0, 0.0)]
        orders = self.OF_OUTPUT if reach.load_turns >= self.TURNS else ()
        return (*of_motor, *((k, reaction, OUTPUT) for k in orders for reaction in (1.0, 0.0)))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """T times cosine and sine, and what they do to the shaft whose angle it is."""
        k, reaction, side = shape
        x, torque = k * (signals.theta_m if side == MOTOR else signals.theta_l), signals.torque[:, None]
        waves, back = wave(x), reaction * k / 2 * torque**2
        return {
            Port.WIND_UP: waves * torque,
            REACTION[side]: waves[:, ::-1] * (1.0, -1.0) * back,
        }

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Relative amplitude of the compliance, and phase."""
        of = "" if fit.shape[2] == MOTOR else "_of_output"
        return harmonic(fit, f"kappa_order_{fit.shape[0]:g}{of}", "1", scale=fit.known.K)
