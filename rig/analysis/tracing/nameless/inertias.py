"""An inertia of the load that is no constant."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import Amount, Nameless, wave_of, when
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals
from rig.model.waves import wave


class UnevenInertia(Nameless):
    """The load's inertia changes along a turn of the output, as that of a crank or of an arm that folds does:
    J_k·cos(k·θ_l + φ), k to 2      [tuttle1992]

    What drives it takes J·α + ½·J′·ω², so that it shows where the load is sped up and where it turns fast.
    """

    name: ClassVar[str] = "uneven_inertia"
    in_short: ClassVar[str] = "the load's inertia changes along the output's turn"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = frozenset({"theta_l", "t"})
    ORDERS: Final = (1, 2)
    LEAST: Final = 0.25  # output turns: in less it is a trend

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where the output turns far enough."""
        return when(reach.load_turns > self.LEAST)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order."""
        alpha, square = np.nan_to_num(signals.alpha_l), np.nan_to_num(signals.omega_l) ** 2
        made = []
        for k in self.ORDERS:
            value = wave(k * np.nan_to_num(signals.theta_l))
            slope = k * np.stack([-value[:, 1], value[:, 0]], 1)
            made.append(value * alpha[:, None] + 0.5 * slope * square[:, None])
        return {Port.LOAD_TORQUE: np.hstack(made)}

    def plausible(self, fit: Fit) -> bool:
        """Neither wave takes more than all there is of the load's inertia, which is nowhere less than nothing."""
        return bool(np.all(np.hypot(fit.coefficients[0::2], fit.coefficients[1::2]) < fit.known.J_l))

    def amount(self, fit: Fit) -> Amount:
        """Of the first order: of the second there may be as much."""
        return wave_of(fit, "once a turn of the output by a wave of", 1000, "g·m²")
