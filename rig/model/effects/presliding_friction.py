"""Friction with memory around reversals."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import play, presliding

MOTOR, LOAD = 0.0, 1.0  # of the first shape parameter: whose friction
# of the last: one bristle, elements side by side that slip one after the other, or bristles of several ways
BRISTLE, ELEMENTS, BRISTLES = 0.0, 1.0, 2.0


class PreslidingFriction(Effect):
    """Instead of jumping, τ_c·sgn ω_m builds up with the way: τ_c·z, dz/dθ_m = (1 − z·sgn ω_m)/x_0; or the load's
    friction τ_cl does, with θ_l      [dahl1968]

    The column is z − sgn ω_m, what the baseline's constant friction has too much after each reversal, and z where the
    sign is not sure. Elements that
    slip one after the other, τ_i after w_i, take any curve that the way from rest makes, and the same at twice the size
    after a reversal      [iwan1966]

    Bristles of several ways, τ_i over w_i, take any curve that is approached from where the last reversal left it, as
    one that has a long tail.
    """

    name: ClassVar[str] = "presliding_friction"
    in_short: ClassVar[str] = "friction with memory around reversals"
    glosses: ClassVar[Mapping[str, str]] = {
        "tau_presliding": "motor friction that builds up after a reversal; of several, of one that loses as much",
        "tau_presliding_l": "load friction that builds up after a reversal",
        "x_0": "angle over which it builds up",
    }
    source: ClassVar[str] = "dahl1968"
    shape_names: ClassVar[tuple[str, ...]] = ("side", "x_0", "law")
    loose: ClassVar[tuple[bool, ...]] = (False, True, False)
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({"law": (BRISTLE,)})
    # two ways near each other share out what is known of both together
    adds: ClassVar[frozenset[str]] = frozenset({"tau_presliding", "tau_presliding_l"})
    WAYS: Final = (0.003, 0.01, 0.03, 0.1, 0.3, 1.0)  # rad of the motor; less than a sample of the slow run at first
    SPREAD: Final = (0.2, 0.6, 1.8, 5.4)  # of x_0: after which ways the elements slip
    DECADES: Final = (0.3, 1.0, 4.0, 16.0)  # of x_0: ways of several bristles
    TURNS: Final = 0.04  # rad/s of the motor: a run that turns faster when it begins has slid before

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Ways longer than the motor, and the load with it, goes between two samples of the slowest run."""
        ways = [x for x in self.WAYS if x > 0.5 * reach.slowest / reach.rate]
        bristles = (*((MOTOR, x, BRISTLE) for x in ways), *((LOAD, x / reach.ratio, BRISTLE) for x in ways))
        several = tuple((MOTOR, x, BRISTLES) for x in ways[1::2])
        return (*bristles, *((MOTOR, x, ELEMENTS) for x in ways[::2]), *several)

    def moved_by_noise(self, shape: Shape) -> bool:
        """The friction of a motor that rests builds up with the way its encoder seems to go."""
        return True

    def has_state(self) -> bool:
        """It builds up."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column, or one an element or bristle."""
        side, x_0, law = shape
        first = signals.omega_m[0] if signals.t.size else 0.0
        start = float(np.sign(first)) if abs(first) > self.TURNS else 0.0
        if side == LOAD:
            return {Port.LOAD_TORQUE: (presliding(signals.theta_l, x_0, start) - signals.way)[:, None]}
        if law == ELEMENTS:
            states = [_element(signals.theta_m, x_0 * share, start) for share in self.SPREAD]
            return {Port.MOTOR_TORQUE: np.stack(states, 1) - signals.way[:, None]}
        if law == BRISTLES:
            states = [presliding(signals.theta_m, x_0 * share, start) for share in self.DECADES]
            return {Port.MOTOR_TORQUE: np.stack(states, 1) - signals.way[:, None]}
        return {Port.MOTOR_TORQUE: (presliding(signals.theta_m, x_0, start) - signals.way)[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The friction that builds up, and over which way."""
        if fit.shape[2] != BRISTLE:
            return self._of_several(fit)
        torque, way = np.eye(4)[[0, 2], : fit.covariance.shape[0]]
        whose = "_l" if fit.shape[0] == LOAD else ""
        return (
            parameter(f"tau_presliding{whose}", fit.coefficients[0], fit.half_width(torque), "N·m"),
            parameter("x_0", fit.shape[1], fit.half_width(way), "rad"),
        )

    def _of_several(self, fit: Fit) -> tuple[Parameter, ...]:
        """Of the one element that loses as much at a reversal, Σ τ_i·w_i, and over as long a way on the average: of a
        short one beside longer ones neither its friction nor the sum of all is known."""
        share = np.array(self.SPREAD if fit.shape[2] == ELEMENTS else self.DECADES)
        c, x_0 = fit.coefficients, fit.shape[1]
        lost, longer = float(share @ c) or 1e-300, float(share**2 @ c) or 1e-300
        torque, way = np.zeros((2, fit.covariance.shape[0]))
        torque[: c.size] = 2 * lost * share / longer - (lost * share / longer) ** 2
        way[: c.size] = x_0 * (share**2 * lost - share * longer) / lost**2
        way[c.size + 1] = longer / lost
        return (
            parameter("tau_presliding", lost**2 / longer, fit.half_width(torque), "N·m"),
            parameter("x_0", x_0 * longer / lost, fit.half_width(way), "rad"),
        )

    def plausible(self, fit: Fit) -> bool:
        """Friction opposes: work is lost at a reversal."""
        if fit.shape[2] == BRISTLE:
            return bool(fit.coefficients[0] > 0)
        return bool(np.array(self.SPREAD if fit.shape[2] == ELEMENTS else self.DECADES) @ fit.coefficients > 0)


def _element(theta: Array, way: float, start: float) -> Array:
    """From −1 to 1 (n,): a spring that slips after `way` rad, `start` at first."""
    gone = theta - theta[:1] + start * way
    return np.asarray((gone - play(gone, way)) / way)
