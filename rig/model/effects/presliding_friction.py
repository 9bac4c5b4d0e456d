"""Friction with memory around reversals."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import play, presliding

MOTOR, LOAD = 0.0, 1.0  # of the first shape parameter: whose friction
# of the last: one bristle, elements side by side that slip one after the other, bristles of several ways, or others
# of those forward than backward
BRISTLE, ELEMENTS, BRISTLES, EACH_WAY = 0.0, 1.0, 2.0, 3.0


class PreslidingFriction(Effect):
    """Instead of jumping, τ_c·sgn ω_m builds up with the way: τ_c·z, dz/dθ_m = (1 − z·sgn ω_m)/x_0; or the load's
    friction τ_cl does, with θ_l      [dahl1968]

    The column is z − sgn ω_m, what the baseline's constant friction has too much after each reversal, and z where the
    sign is not sure. Elements that
    slip one after the other, τ_i after w_i, take any curve that the way from rest makes, and the same at twice the size
    after a reversal      [iwan1966]

    Bristles of several ways, τ_i over w_i, take any curve that is approached from where the last reversal left it, as
    one that has a long tail; and another one forward than backward, where a loop closes differently at its two ends.
    """

    name: ClassVar[str] = "presliding_friction"
    in_short: ClassVar[str] = "friction with memory around reversals"
    glosses: ClassVar[Mapping[str, str]] = {
        "tau_presliding": "motor friction that builds up after a reversal; of several all, or one that loses as much",
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
    SETS_OUT: Final = 0.6  # of the low-passed speed, what the angle shows of it in the first two steps from rest
    TURNS: Final = 0.04  # rad/s of the motor: a run that turns faster when it begins has slid before

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Ways longer than the motor, and the load with it, goes between two samples of the slowest run."""
        ways = [x for x in self.WAYS if x > 0.5 * reach.slowest / reach.rate]
        bristles = (*((MOTOR, x, BRISTLE) for x in ways), *((LOAD, x / reach.ratio, BRISTLE) for x in ways))
        several = tuple((MOTOR, x, law) for law in (BRISTLES, EACH_WAY) for x in ways[1::2])
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
        start = self._before(signals)
        if side == LOAD:
            return {Port.LOAD_TORQUE: (presliding(signals.theta_l, x_0, start) - signals.way)[:, None]}
        if law == ELEMENTS:
            states = [_element(signals.theta_m, x_0 * share, start) for share in self.SPREAD]
            return {Port.MOTOR_TORQUE: np.stack(states, 1) - signals.way[:, None]}
        if law in (BRISTLES, EACH_WAY):
            states = [presliding(signals.theta_m, x_0 * share, start) for share in self.DECADES]
            missing = np.stack(states, 1) - signals.way[:, None]
            return {Port.MOTOR_TORQUE: missing if law == BRISTLES else _each_way(missing, signals.way)}
        return {Port.MOTOR_TORQUE: (presliding(signals.theta_m, x_0, start) - signals.way)[:, None]}

    def _before(self, s: Signals) -> float:
        """Which way the motor had slid before the run began, 0 of one that begins at rest: the low-passed speed looks
        ahead, so that the first two steps of the angle are asked as well."""
        first = float(s.omega_m[0]) if s.t.size else 0.0
        step = float(s.theta_m[2] - s.theta_m[0]) / (2 * s.dt) if s.t.size > 2 else first
        slid = abs(first) > self.TURNS and not abs(step) < self.SETS_OUT * abs(first)
        return float(np.sign(first)) if slid else 0.0

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
        """All that builds up, and over which way on the average; or where that is known better, as of a short one
        beside longer ones, the one element that loses as much at a reversal, Σ τ_i·w_i, over as long a way. Of what is
        another each way, the mean."""
        share, ways = self._shares(fit), 2.0 if fit.shape[2] == EACH_WAY else 1.0
        told = [_as_one(fit, share, power, ways) for power in (1, 0)]
        return min(told, key=lambda words: _width(words[0]))

    def plausible(self, fit: Fit) -> bool:
        """Friction opposes: work is lost at a reversal."""
        if fit.shape[2] == BRISTLE:
            return bool(fit.coefficients[0] > 0)
        return bool(self._shares(fit) @ fit.coefficients > 0)

    def _shares(self, fit: Fit) -> Array:
        """Of x_0, the way of each coefficient, (k,)."""
        return np.array({ELEMENTS: self.SPREAD, BRISTLES: self.DECADES, EACH_WAY: 2 * self.DECADES}[fit.shape[2]])


def _each_way(x: Array, way: Array) -> Array:
    """Columns (n, k) forward, then backward, (n, 2k); where the way (n,) is not sure, as they are themselves."""
    forward = np.where(way[:, None] != 0.0, way[:, None] > 0.0, x > 0.0)
    return np.hstack([np.where(forward, x, 0.0), np.where(forward, 0.0, x)])


def _element(theta: Array, way: float, start: float) -> Array:
    """From −1 to 1 (n,): a spring that slips after `way` rad, `start` at first."""
    gone = theta - theta[:1] + start * way
    return np.asarray((gone - play(gone, way)) / way)


def _as_one(fit: Fit, share: Array, power: int, ways: float) -> tuple[Parameter, Parameter]:
    """Several bristles or elements over `share` (k,) of x_0 as one: with M_j = Σ τ_i·share_iʲ, of the friction
    M_p^(p+1)/M_(p+1)^p, over the way x_0·M_(p+1)/M_p."""
    c, x_0 = fit.coefficients, fit.shape[1]
    less, more = share**power, share ** (power + 1)
    lost, longer = float(less @ c) or 1e-300, float(more @ c) or 1e-300
    torque, way = np.zeros((2, fit.covariance.shape[0]))
    ratio = lost / longer
    torque[: c.size] = ((power + 1) * ratio**power * less - power * ratio ** (power + 1) * more) / ways
    way[: c.size] = x_0 * (more * lost - less * longer) / lost**2
    way[c.size + 1] = longer / lost
    return (
        parameter("tau_presliding", lost * ratio**power / ways, fit.half_width(torque), "N·m"),
        parameter("x_0", x_0 * longer / lost, fit.half_width(way), "rad"),
    )


def _width(figure: Parameter) -> float:
    """Of its interval, over itself."""
    return (figure.ci95[1] - figure.ci95[0]) / max(abs(figure.value), 1e-300)
