"""The change of an effect's columns with one of its shape parameters, as an effect of its own for the refit."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals


@dataclass(frozen=True)
class Slope(Effect):
    """One column: d(columns · coefficients)/d ln(shape[i]), by central difference."""

    of: Effect
    i: int
    nudge: float
    coefficients: tuple[float, ...]
    noise_kept: bool = False  # for intervals

    name: ClassVar[str] = "slope"
    in_short: ClassVar[str] = "change of an effect with its shape"
    source: ClassVar[str] = "fuller1987"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """None of its own."""
        return ()

    def moved_by_noise(self, shape: Shape) -> bool:
        """As the effect, or no noise of it is to be taken off."""
        return self.noise_kept or self.of.moved_by_noise(shape)

    def has_state(self) -> bool:
        """As the effect."""
        return self.of.has_state()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """(n, 1) at every port of the effect."""
        up, down = (
            self.of.columns(signals, (*shape[: self.i], shape[self.i] * factor, *shape[self.i + 1 :]))
            for factor in (np.exp(self.nudge), np.exp(-self.nudge))
        )
        c = np.array(self.coefficients)
        return {port: ((up[port] - down[port]) @ c)[:, None] / (2 * self.nudge) for port in up}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """None."""
        return ()
