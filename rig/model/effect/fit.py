"""What a fit says of an effect: its coefficients, and the figures that people know it by, with intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.core.quantiles import Z95
from rig.model.effect.known import Known

Array = npt.NDArray[np.float64]
Shape = tuple[float, ...]
"""The parameters an effect depends on nonlinearly (a Stribeck speed, an order), in `shape_names`' order."""


@dataclass(frozen=True)
class Fit:
    """What the data say of one effect: coefficients (k,), then shape (s,); covariance (k+s, k+s) of both together.
    `beside_series` (k+s+2n, k+s+2n) is that of both and of the cosines and sines, in turn, of the kinematic error that
    is `known`, a share of which is known no better than what stays of it. `tau_c` is the model's Coulomb
    friction beside the effect, N·m, where it was fitted."""

    coefficients: Array
    shape: Shape
    covariance: Array
    known: Known
    ratio: float
    beside_series: Array | None = None
    tau_c: float | None = None

    def half_width(self, gradient: Array) -> float:
        """Half the 95 % interval of a figure whose gradient by (coefficients, shape) is `gradient` (k+s,), or by them
        and the series' cosines and sines in turn: of these nothing is uncertain where that is not told."""
        size = len(self.covariance)
        if gradient.size == size or self.beside_series is None:
            return _half(gradient[:size], self.covariance)
        return _half(gradient, self.beside_series)


def _half(gradient: Array, covariance: Array) -> float:
    return float(Z95 * np.sqrt(max(0.0, float(gradient @ covariance @ gradient))))


@dataclass(frozen=True)
class Parameter:
    """A figure of an effect in the words of the field."""

    name: str
    value: float
    ci95: tuple[float, float]
    unit: str

    @property
    def holds_zero(self) -> bool:
        """Whether its interval does."""
        return self.ci95[0] <= 0 <= self.ci95[1]


def parameter(name: str, value: float, half: float, unit: str) -> Parameter:
    """A parameter with a symmetric interval."""
    return Parameter(name, float(value), (float(value - half), float(value + half)), unit)


def harmonic(fit: Fit, name: str, unit: str, first: int = 0, scale: float = 1.0) -> tuple[Parameter, Parameter]:
    """c·cos x + s·sin x = A·cos(x + phase) from coefficients `first` and `first + 1`: amplitude A and phase."""
    c, s = fit.coefficients[first] * scale, fit.coefficients[first + 1] * scale
    size = float(np.hypot(c, s)) or 1e-300
    along, around = np.zeros(fit.covariance.shape[0]), np.zeros(fit.covariance.shape[0])
    along[first : first + 2] = np.array([c, s]) / size * scale
    around[first : first + 2] = np.array([s, -c]) / size**2 * scale
    return (
        parameter(f"{name}_amplitude", size, fit.half_width(along), unit),
        parameter(f"{name}_phase", float(np.arctan2(-s, c)), fit.half_width(around), "rad"),
    )
