"""The kinematic error shrinks as the load presses the teeth into mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np
from scipy.signal import lfilter

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.fourier import FourierSeries

TORQUE, SIZE = 0.0, 1.0  # of the first shape parameter: what is lagged
EACH = 2.0  # added to it where the large orders shrink each by its own share
ORDERS = (1, 2, 4)  # the large ones of a strain-wave gear, two lobes and what they lack; the others go together


class LoadDependentKinematicError(Effect):
    """θ̃_p scales by A_∞ + (1 − A_∞)·exp(−|T̄|/T_c)      [ghorbel2001, Fig. 9]

    The baseline's own series carries A_∞; the column is the part that goes away. T̄ follows the torque with a lag of
    the first order, for the mesh settles under a load, it does not jump: |T̄|, or the lagged |T| where the teeth are
    pressed alike whichever way they push. The two differ where the torque swings through zero within the lag.

    The paper's profiles change as they shrink: orders 1, 2 and 4 may each have an A_∞ of their own.
    """

    name: ClassVar[str] = "load_dependent_kinematic_error"
    in_short: ClassVar[str] = "kinematic error shrinks as load grows (the paper's Fig. 9)"
    source: ClassVar[str] = "ghorbel2001, Fig. 9"
    shape_names: ClassVar[tuple[str, ...]] = ("of", "T_c", "lag")
    loose: ClassVar[tuple[bool, ...]] = (False, True, True)
    LAG: Final = 3e-3  # s, to start the refit from: a few periods of tooth contact
    LAGS: Final = (1e-4, 0.5)  # s
    FEW: Final = (1.5, 3.0, 6.0)  # N·m, of the law by orders, which the refit takes on from there
    TORQUES: Final = (0.7, 1.5, 3.0, 6.0, 12.0, 25.0)  # N·m, octaves around the 2.5 N·m that Fig. 9 suggests

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Decay torques the campaign's loads can show."""
        laws = ((TORQUE, self.TORQUES), (SIZE, self.TORQUES), (TORQUE + EACH, self.FEW), (SIZE + EACH, self.FEW))
        return tuple((of, c, self.LAG) for of, torques in laws for c in torques if c < 1.5 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """The fitted series times the decay, and its lever; by orders where each has its own share."""
        of, t_c, lag = shape
        torque = np.abs(signals.torque) if of % EACH == SIZE else signals.torque
        decay = np.exp(-np.abs(lagged(torque, lag, signals.dt)) / t_c)[:, None]
        values, slopes = signals.series_value[:, None], signals.series_slope[:, None]
        if of >= EACH:
            values, slopes = _by_orders(signals.gear.kinematic_error, signals.theta_m, values, slopes)
        return {Port.KINEMATIC_ERROR: values * decay, Port.LEVER: slopes * decay}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """A_∞ = 1/(1 + c), c the share that goes away over the share that stays, of the largest order and, by orders,
        of each; T_c; the lag."""
        c = fit.coefficients
        unit = np.eye(c.size + 3)

        def left(i: int, name: str) -> Parameter:
            return parameter(name, 1.0 / (1.0 + c[i]), fit.half_width(unit[i] / (1.0 + c[i]) ** 2), "1")

        largest = self._largest(fit)
        each = [left(i, f"A_inf_order_{n}") for i, n in enumerate(ORDERS) if i != largest] if c.size > 1 else []
        return (
            left(largest, "A_inf"),
            *each,
            parameter("T_c", fit.shape[1], fit.half_width(unit[c.size + 1]), "N·m"),
            parameter("lag", fit.shape[2], fit.half_width(unit[c.size + 2]), "s"),
        )

    def _largest(self, fit: Fit) -> int:
        """Which of the orders that have a share of their own is the largest in the gear."""
        amplitude = fit.known.kinematic_error.amplitude
        own = [float(amplitude[n - 1]) if n <= amplitude.size else 0.0 for n in ORDERS]
        return int(np.argmax(own)) if fit.coefficients.size > 1 else 0

    def plausible(self, fit: Fit) -> bool:
        """It shrinks, and does not change its sign."""
        return bool(fit.coefficients[self._largest(fit)] > 0)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of the law (chosen), T_c and the lag."""
        return (TORQUE, SIZE + EACH), (0.3 * self.TORQUES[0], 2.0 * self.TORQUES[-1]), self.LAGS


def _by_orders(series: FourierSeries, theta: Array, values: Array, slopes: Array) -> tuple[Array, Array]:
    """The waves of ORDERS and what is left of the whole, (n, 4), and their slopes by θ_m."""
    a, b = (np.array([part[n - 1] if n <= len(part) else 0.0 for n in ORDERS]) for part in (series.a, series.b))
    n = np.array(ORDERS, dtype=float)
    angle = np.multiply.outer(theta, n)
    waves = a * np.cos(angle) + b * np.sin(angle)
    steep = n * (b * np.cos(angle) - a * np.sin(angle))
    return (
        np.hstack([waves, values - waves.sum(1, keepdims=True)]),
        np.hstack([steep, slopes - steep.sum(1, keepdims=True)]),
    )


def lagged(x: Array, lag: float, dt: float) -> Array:
    """`x` (n,) through a first-order lag of `lag` s, begun in steady state."""
    keep = float(np.exp(-dt / lag))
    straight = 0.5 * (1.0 - keep)  # of this sample and of the one before: a straight line between them
    y, _ = lfilter([straight, straight], [1.0, -keep], x, zi=[x[0] * (1.0 - straight)])
    return np.asarray(y)
