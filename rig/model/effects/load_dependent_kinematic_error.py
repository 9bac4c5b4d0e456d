"""The kinematic error shrinks as the load presses the teeth into mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np
from scipy.signal import lfilter

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

TORQUE, SIZE = 0.0, 1.0  # of the first shape parameter: what is lagged


class LoadDependentKinematicError(Effect):
    """θ̃_p scales by A_∞ + (1 − A_∞)·exp(−|T̄|/T_c)      [ghorbel2001, Fig. 9]

    The baseline's own series carries A_∞; the column is the part that goes away. T̄ follows the torque with a lag of
    the first order, for the mesh settles under a load, it does not jump: |T̄|, or the lagged |T| where the teeth are
    pressed alike whichever way they push. The two differ where the torque swings through zero within the lag.
    """

    name: ClassVar[str] = "load_dependent_kinematic_error"
    in_short: ClassVar[str] = "kinematic error shrinks as load grows (the paper's Fig. 9)"
    source: ClassVar[str] = "ghorbel2001, Fig. 9"
    shape_names: ClassVar[tuple[str, ...]] = ("of", "T_c", "lag")
    loose: ClassVar[tuple[bool, ...]] = (False, True, True)
    LAG: Final = 3e-3  # s, to start the refit from: a few periods of tooth contact
    LAGS: Final = (1e-4, 0.5)  # s
    TORQUES: Final = (0.7, 1.5, 3.0, 6.0, 12.0, 25.0)  # N·m, octaves around the 2.5 N·m that Fig. 9 suggests

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Decay torques the campaign's loads can show."""
        return tuple((of, c, self.LAG) for of in (TORQUE, SIZE) for c in self.TORQUES if c < 1.5 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """The fitted series times the decay, and its lever."""
        of, t_c, lag = shape
        torque = np.abs(signals.torque) if of == SIZE else signals.torque
        decay = np.exp(-np.abs(lagged(torque, lag, signals.dt)) / t_c)
        return {
            Port.KINEMATIC_ERROR: (signals.series_value * decay)[:, None],
            Port.LEVER: (signals.series_slope * decay)[:, None],
        }

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """A_∞ = 1/(1 + c), c the share that goes away over the share that stays; T_c; the lag."""
        c = fit.coefficients[0]
        by_c, _, by_t, by_lag = np.eye(4)
        by_c = by_c * -1.0 / (1.0 + c) ** 2
        return (
            parameter("A_inf", 1.0 / (1.0 + c), fit.half_width(by_c), "1"),
            parameter("T_c", fit.shape[1], fit.half_width(by_t), "N·m"),
            parameter("lag", fit.shape[2], fit.half_width(by_lag), "s"),
        )

    def plausible(self, fit: Fit) -> bool:
        """It shrinks, and does not change its sign."""
        return bool(fit.coefficients[0] > 0)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of the law (chosen), T_c and the lag."""
        return (TORQUE, SIZE), (0.3 * self.TORQUES[0], 2.0 * self.TORQUES[-1]), self.LAGS


def lagged(x: Array, lag: float, dt: float) -> Array:
    """`x` (n,) through a first-order lag of `lag` s, begun in steady state."""
    keep = float(np.exp(-dt / lag))
    straight = 0.5 * (1.0 - keep)  # of this sample and of the one before: a straight line between them
    y, _ = lfilter([straight, straight], [1.0, -keep], x, zi=[x[0] * (1.0 - straight)])
    return np.asarray(y)
