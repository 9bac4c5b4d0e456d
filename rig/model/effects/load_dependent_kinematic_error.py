"""The kinematic error shrinks as the load presses the teeth into mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Known, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.fourier import FourierSeries
from rig.model.memory import lagged
from rig.model.waves import powers

TORQUE, SIZE = 0.0, 1.0  # of the first shape parameter: what is lagged
EACH = 2.0  # added to it where the large orders shrink each by its own share
SIDED = 4.0  # in its place: what more is left under positive torque than under negative
UNTOLD = 1e-3  # of a lag, half its interval: nothing that is told is told so well
NONE = 1e-12  # rad: a wave so small is none
ORDERS = (1, 2, 4)  # the large ones of a strain-wave gear, two lobes and what they lack; the others go together


class LoadDependentKinematicError(Effect):
    """θ̃_p scales by A_∞ + (1 − A_∞)·exp(−(|T̄|/T_c)^δ)      [ghorbel2001, Fig. 9]

    The baseline's own series carries A_∞; the column is the part that goes away. T̄ follows the torque of the
    spring, B_sp/K behind that of the shaft, with a lag of the first order, for the mesh settles under a load, it does
    not jump: |T̄|, or the lagged |T| where the teeth are pressed alike whichever way they push. The two differ where the
    torque swings through zero within the lag.

    The paper's profiles change as they shrink: orders 1, 2 and 4 may each lose a wave of its own, whose size and phase
    are fitted. As shares of what stays they would have no phase where little stays. The rest of them shrinks together,
    and may turn together, as a profile does that shifts by an angle under load.

    Flanks that were not cut alike shrink it by another share one way than the other: θ̃_p gains d·sgn T̄·(1 − exp(…))
    of itself beside the rest (SIDED). A spring that changes with the angle draws that too, with more numbers.

    δ is 1 in Fig. 9, as far as five loads tell. Teeth that come into contact one by one spread the fall over decades of
    torque, clearances of one size end it at one: 0.6 and 2 come within a tenth of a power law and of a straight line.
    """

    name: ClassVar[str] = "load_dependent_kinematic_error"
    in_short: ClassVar[str] = "kinematic error shrinks as load grows (the paper's Fig. 9)"
    glosses: ClassVar[Mapping[str, str]] = {
        "A_inf": "A_∞, share of the largest order that stays under a high load",
        "A_inf_order_{n}": "A_∞ of order {n}, the share of it that stays",
        "T_c": "torque through the gear over which the rest goes away",
        "lag": "time constant by which the kinematic error follows the torque",
        "uneven": "d, by what share more of it stays under positive torque, and less under negative",
    }
    source: ClassVar[str] = "ghorbel2001, Fig. 9"
    shape_names: ClassVar[tuple[str, ...]] = ("of", "T_c", "lag", "delta")
    loose: ClassVar[tuple[bool, ...]] = (False, True, True, False)
    adds: ClassVar[frozenset[str]] = frozenset({"A_inf", *(f"A_inf_order_{n}" for n in ORDERS)})
    LAG: Final = 3e-3  # s, to start the refit from: a few periods of tooth contact
    LAGS: Final = (1e-4, 0.5)  # s
    FEW: Final = (1.5, 3.0, 6.0)  # N·m, of the laws the refit takes on from there
    LATER: Final = (2.0, 6.0, 12.0)
    SPREAD, SUDDEN = 0.6, 2.0  # δ
    TORQUES: Final = (0.7, 1.5, 3.0, 6.0, 12.0, 25.0)  # N·m, octaves around the 2.5 N·m that Fig. 9 suggests

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Decay torques the campaign's loads can show."""
        whole = [(of, c, 1.0) for of in (TORQUE, SIZE) for c in self.TORQUES]
        orders = [(of + EACH, c, 1.0) for of in (TORQUE, SIZE) for c in self.FEW]
        other = [(of, c, delta) for of in (TORQUE, EACH) for delta in (self.SPREAD, self.SUDDEN) for c in self.LATER]
        return tuple((of, c, self.LAG, delta) for of, c, delta in (*whole, *orders, *other) if c < 1.5 * reach.torque)

    def shapes_beside(self, reach: Reach) -> tuple[Shape, ...]:
        """What is uneven about it, over torques as far apart."""
        return tuple((SIDED, c, self.LAG, 1.0) for c in self.TORQUES if c < 1.5 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """The fitted series times the decay, and its lever; by orders where each has its own share."""
        of, t_c, lag, delta = shape

        def late(whole: Signals) -> tuple[Array, ...]:
            # not `spring_torque`: its speed of the wind-up leans on the θ̃_p′ that is without load
            torque = lagged(whole.torque, whole.gear.damped_for, whole.dt)
            return (lagged(np.abs(torque) if of % EACH == SIZE else torque, lag, whole.dt),)

        torque = signals.states(late, of % EACH, lag)[0]
        decay = np.exp(-((np.abs(torque) / t_c) ** delta))[:, None]
        values, slopes = signals.series_value[:, None], signals.series_slope[:, None]
        if of == SIDED:
            decay = np.sign(torque)[:, None] * (1.0 - decay)
        elif of >= EACH:
            values, slopes = signals.once(self.name, lambda: _by_orders(signals, values, slopes))
        return {Port.KINEMATIC_ERROR: values * decay, Port.LEVER: slopes * decay}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """A_∞, the share that stays of the largest order and, by orders, of each; T_c; the lag."""
        k = fit.coefficients.size
        unit = np.eye(k + len(fit.shape))
        if fit.shape[0] == SIDED:
            return (parameter("uneven", fit.coefficients[0], fit.half_width(unit[0]), "1"),)
        shares = [_stays_of(fit, i) for i in range(len(ORDERS))] if k > 1 else [_stays(fit)]
        largest = _largest(fit)
        each = [_left(fit, f"A_inf_order_{n}", shares[i]) for i, n in enumerate(ORDERS[: len(shares)]) if i != largest]
        return (
            _left(fit, "A_inf", shares[largest]),
            *each,
            parameter("T_c", fit.shape[1], fit.half_width(unit[k + 1]), "N·m"),
            self._lag(fit.shape[2], fit.half_width(unit[k + 2])),
        )

    def together(self, name: str, fits: Sequence[Fit]) -> float:
        """Of an order, or of the largest without load: what stays, which is the same in each, over that and all that
        goes away, which may cancel."""
        known = fits[0].known
        stays = {n: np.array(_wave(known.kinematic_error, n)) for n in ORDERS}
        gone = {n: sum(self.unloaded(n, known, fit.shape) @ fit.coefficients for fit in fits) for n in ORDERS}
        sizes = {n: float(np.hypot(*(stays[n] + gone[n]))) for n in ORDERS}
        order = max(sizes, key=lambda n: sizes[n]) if name == "A_inf" else int(name.rpartition("_")[2])
        return float(np.hypot(*stays[order])) / max(sizes[order], NONE)

    def _lag(self, lag: float, half: float) -> Parameter:
        """One too short for the rows to tell may be any from none to the shortest they do tell."""
        told = parameter("lag", lag, half, "s")
        return told if half > UNTOLD * lag else replace(told, ci95=(0.0, max(lag, self.LAG)))

    def unloaded(self, order: int, known: Known, shape: Shape) -> Array:
        """What goes away under load: the baseline's series has what stays."""
        wave = np.array(_wave(known.kinematic_error, order))
        if shape[0] == SIDED:
            return np.zeros((2, 1))
        if shape[0] < EACH:
            return wave[:, None]
        made = np.zeros((2, 2 * len(ORDERS) + 2))
        if order in ORDERS:
            i = ORDERS.index(order)
            made[0, i] = made[1, i + len(ORDERS)] = 1.0
        else:
            made[:, -2] = wave
            made[:, -1] = order * wave[1], -order * wave[0]
        return made

    def plausible(self, fit: Fit) -> bool:
        """It shrinks; as a whole it does not change its sign."""
        if fit.shape[0] == SIDED:
            return bool(abs(fit.coefficients[0]) < 1.0)
        share, _ = _stays_of(fit, _largest(fit)) if fit.coefficients.size > 1 else _stays(fit)
        return bool(0.0 <= share < 1.0)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of the law (chosen), T_c, the lag, and δ (chosen)."""
        torques = (0.3 * self.TORQUES[0], 2.0 * self.TORQUES[-1])
        return (TORQUE, SIDED), torques, self.LAGS, (self.SPREAD, self.SUDDEN)


def _by_orders(signals: Signals, values: Array, slopes: Array) -> tuple[Array, Array]:
    """Cosine and sine of ORDERS, rad each, what is left of the whole without them and its slope, (n, 8); and the slopes
    of all by θ_m."""
    series = signals.gear.kinematic_error
    n = np.array(ORDERS)
    waves = powers(signals.theta_m, max(ORDERS))
    cos, sin = waves[:, 0::2][:, n - 1], waves[:, 1::2][:, n - 1]
    a, b = np.array([_wave(series, order) for order in ORDERS]).T
    slope = slopes - (cos @ (n * b) - sin @ (n * a))[:, None]
    bend = (signals.series_bend + cos @ (n**2 * a) + sin @ (n**2 * b))[:, None]
    return (
        np.hstack([cos, sin, values - (cos @ a + sin @ b)[:, None], slope]),
        np.hstack([-n * sin, n * cos, slope, bend]),
    )


def _wave(series: FourierSeries, order: int) -> tuple[float, float]:
    """Cosine and sine coefficient of an order, zero where the series does not reach."""
    return (series.a[order - 1], series.b[order - 1]) if order <= len(series.a) else (0.0, 0.0)


def _largest(fit: Fit) -> int:
    """Which of the orders that lose a wave of their own is the largest without load."""
    if fit.coefficients.size == 1:
        return 0
    return int(np.argmax([np.hypot(*_unloaded(fit, i)) for i in range(len(ORDERS))]))


def _unloaded(fit: Fit, i: int) -> Array:
    """Cosine and sine of the i-th of ORDERS without load: what stays and what goes away, rad, (2,)."""
    return np.array(_wave(fit.known.kinematic_error, ORDERS[i])) + fit.coefficients[[i, i + len(ORDERS)]]


Share = tuple[float, Array]
"""A share that stays, and its gradient by coefficients, shape and the series' cosines and sines in turn (k+s+2n,)."""


def _stays(fit: Fit) -> Share:
    """1/(1 + c), c the share that goes away over the one that stays; of the largest order, |p|/|p + c·p_0|, which p is
    p_0."""
    c = fit.coefficients[0]
    gradient, first = _flat(fit)
    gradient[0] = -1.0 / (1.0 + c) ** 2
    waves = np.array([_wave(fit.known.kinematic_error, n) for n in ORDERS])
    largest = int(np.argmax(np.hypot(*waves.T)))
    size = max(float(np.hypot(*waves[largest])), NONE)
    _put(gradient, first, ORDERS[largest], waves[largest] / size**2 * c / (1.0 + c) ** 2)
    return float(1.0 / (1.0 + c)), gradient


def _flat(fit: Fit) -> tuple[Array, int]:
    """A gradient of zeros, and where in it the series begins."""
    first = fit.coefficients.size + len(fit.shape)
    return np.zeros(first + 2 * len(fit.known.kinematic_error.a)), first


def _put(gradient: Array, first: int, order: int, wave: Array) -> None:
    """Into a gradient, that by the cosine and sine of one order, where the series reaches so far."""
    at = first + 2 * (order - 1)
    if at < gradient.size:
        gradient[at : at + 2] = wave


def _stays_of(fit: Fit, i: int) -> Share:
    """|p|/|p + g| of the i-th of ORDERS, p what stays of it and g what goes away."""
    whole, stays = _unloaded(fit, i), np.array(_wave(fit.known.kinematic_error, ORDERS[i]))
    size = max(float(np.hypot(*whole)), NONE)
    share = float(np.hypot(*stays)) / size
    gradient, first = _flat(fit)
    gradient[[i, i + len(ORDERS)]] = -share * whole / size**2
    _put(gradient, first, ORDERS[i], stays / max(float(np.hypot(*stays)), NONE) / size - share * whole / size**2)
    return share, gradient


def _left(fit: Fit, name: str, share: Share) -> Parameter:
    return parameter(name, share[0], fit.half_width(share[1]), "1")
