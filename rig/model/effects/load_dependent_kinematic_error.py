"""The kinematic error shrinks as the load presses the teeth into mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class LoadDependentKinematicError(Effect):
    """θ̃_p scales by A_∞ + (1 − A_∞)·exp(−|T|/T_c)      [ghorbel2001, Fig. 9]

    The baseline's own series carries A_∞; the column is the part that goes away.
    """

    name: ClassVar[str] = "load_dependent_kinematic_error"
    in_short: ClassVar[str] = "kinematic error shrinks as load grows (the paper's Fig. 9)"
    source: ClassVar[str] = "ghorbel2001, Fig. 9"
    shape_names: ClassVar[tuple[str, ...]] = ("T_c",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    TORQUES: Final = (0.7, 1.5, 3.0, 6.0, 12.0, 25.0)  # N·m, octaves around the 2.5 N·m that Fig. 9 suggests

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Decay torques the campaign's loads can show."""
        return tuple((c,) for c in self.TORQUES if c < 1.5 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """The fitted series times the decay, and its lever."""
        decay = np.exp(-np.abs(signals.torque) / shape[0])
        series = signals.gear.kinematic_error
        return {
            Port.KINEMATIC_ERROR: (series.value(signals.theta_m) * decay)[:, None],
            Port.LEVER: (series.slope(signals.theta_m) * decay)[:, None],
        }

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """A_∞ = 1/(1 + c), c the share that goes away over the share that stays, and T_c."""
        c = fit.coefficients[0]
        by_c, by_t = np.zeros(fit.covariance.shape[0]), np.zeros(fit.covariance.shape[0])
        by_c[0] = -1.0 / (1.0 + c) ** 2
        by_t[-1] = 1.0
        return (
            parameter("A_inf", 1.0 / (1.0 + c), fit.half_width(by_c), "1"),
            parameter("T_c", fit.shape[0], fit.half_width(by_t), "N·m"),
        )

    def plausible(self, fit: Fit) -> bool:
        """It shrinks, and does not change its sign."""
        return bool(fit.coefficients[0] > 0)
