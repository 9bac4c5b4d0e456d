"""Friction that changes over a turn of the wave generator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.gloss import waved
from rig.model.waves import wave


class PositionDependentFriction(Effect):
    """τ_f gains τ_k·cos(k·θ_m + φ)·sgn ω_m      [tuttle1992]

    What rubs on the flexspline turns with it: k·(1 ± 1/N), 2.04 beside 2.

    Cogging keeps its sign when the motor turns back; this does not. One direction alone cannot tell them apart.
    """

    name: ClassVar[str] = "position_dependent_friction"
    in_short: ClassVar[str] = "friction modulated by wave-generator angle"
    glosses: ClassVar[Mapping[str, str]] = waved(
        "order_{n}", "the friction that changes {n} times a motor turn", "{n}·θ_m"
    )
    source: ClassVar[str] = "tuttle1992"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    comes_round: ClassVar[bool] = True
    loose: ClassVar[tuple[bool, ...]] = (False,)
    ORDERS: Final = tuple(float(k) for k in range(1, 9))  # two lobes, their halves, a tight spot between them
    SHARP: Final = tuple(float(k) for k in range(9, 13))  # edges of a tight spot, where cogging is told by the way back
    RIDING: Final = (2.0, 4.0, 6.0)  # of the flexspline, whose lobes are two
    LEAST: Final = 0.15  # output turns, over which 2.04 and 2 come apart

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Low orders of the motor, higher ones where it turns both ways, and what rides on the flexspline where the
        output turns far enough to tell."""
        sides = (1.0, -1.0) if reach.load_turns >= self.LEAST else ()
        riding = (k * (1.0 + sigma / reach.ratio) for sigma in sides for k in self.RIDING)
        sharp = self.SHARP if reach.both_ways else ()
        return tuple((k,) for k in (*self.ORDERS, *sharp, *riding))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine, with the sign of the motion."""
        x = shape[0] * signals.theta_m
        return {Port.MOTOR_TORQUE: wave(x, signals.way)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:.4g}", "N·m")
