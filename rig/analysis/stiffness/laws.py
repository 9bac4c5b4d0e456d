"""Spring laws: odd functions torque(u) of the wind-up u from its middle, with their parameters scaled to order one."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array


@dataclass(frozen=True)
class Scale:
    """What one is: the secant stiffness and the largest wind-up."""

    K: float  # N·m/rad
    reach: float  # rad

    @property
    def torque(self) -> float:
        """N·m"""
        return self.K * self.reach


class Law(ABC):
    """τ = f(u), odd. `p` (m,) are its parameters in the units of `scale`."""

    name: str
    words: str  # for people

    @abstractmethod
    def starts(self) -> list[list[float]]:
        """Where a fit may begin; more than one where it could end in a wrong valley."""

    @abstractmethod
    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """N·m at `u` rad, any shape."""

    @abstractmethod
    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """The parameters by name, SI."""

    def tangent(self, u: Array, p: Array, scale: Scale) -> Array:
        """dτ/du [N·m/rad] at `u` rad."""
        step = 1e-4 * scale.reach
        return np.asarray((self.torque(u + step, p, scale) - self.torque(u - step, p, scale)) / (2 * step))

    def windup(self, tau: Array, p: Array, scale: Scale) -> Array:
        """The inverse [rad] at `tau` N·m, by interpolation; NaN beyond 1.5 times what was tested."""
        u = np.linspace(-1.5, 1.5, 3001) * scale.reach
        return np.interp(tau, np.maximum.accumulate(self.torque(u, p, scale)), u, left=np.nan, right=np.nan)


class Line(Law):
    """τ = K·u"""

    name, words = "linear", "one line"

    def starts(self) -> list[list[float]]:
        """The secant."""
        return [[1.0]]

    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """K·u"""
        return np.asarray(p[0] * scale.K * u)

    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """K"""
        return {"K": float(p[0]) * scale.K}


class Cubic(Law):
    """τ = k1·u + k3·u³"""

    name, words = "cubic", "a cubic"

    def starts(self) -> list[list[float]]:
        """The secant."""
        return [[1.0, 0.0]]

    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """k1·u + k3·u³"""
        x = u / scale.reach
        return np.asarray(scale.torque * (p[0] * x + p[1] * x**3))

    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """k1 N·m/rad, k3 N·m/rad³"""
        return {"k1": float(p[0]) * scale.K, "k3": float(p[1]) * scale.K / scale.reach**2}


class Play(Law):
    """τ = K·(u − b) beyond b, nothing within: backlash in series with a straight spring"""

    name, words = "play", "a straight spring with play"

    def starts(self) -> list[list[float]]:
        """The secant with a little play, and some more: within it the sum of squares is flat."""
        return [[1.0, 0.03], [1.1, 0.12]]

    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """K·(u ∓ b) beyond ±b."""
        beyond = np.maximum(np.abs(u) - max(float(p[1]), 0.0) * scale.reach, 0.0)
        return np.asarray(p[0] * scale.K * np.sign(u) * beyond)

    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """K N·m/rad; b rad"""
        return {"K": float(p[0]) * scale.K, "b": max(float(p[1]), 0.0) * scale.reach}


def lines(u: Array, K: Array, T: Array) -> Array:
    """Torque of the three lines K1 to `T[0]` N·m, K2 to `T[1]`, K3 beyond, at `u` rad: continuous and odd."""
    size = np.abs(u)
    first = T[0] / K[0]
    second = first + (T[1] - T[0]) / K[1]
    bent = np.where(size < second, T[0] + K[1] * (size - first), T[1] + K[2] * (size - second))
    return np.asarray(np.sign(u) * np.where(size < first, K[0] * size, bent))


@dataclass(frozen=True)
class Lines(Law):
    """Three lines with knots at torques known beforehand, as shares of scale.torque."""

    T1: float
    T2: float

    name = "lines"
    words = "three lines with given knots"

    def starts(self) -> list[list[float]]:
        """The secant."""
        return [[1.0, 1.0, 1.0]]

    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """K1 to T1, K2 to T2, K3 beyond."""
        return lines(u, np.maximum(p, 0.02) * scale.K, np.array([self.T1, self.T2]) * scale.torque)

    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """K1, K2, K3 N·m/rad; T1, T2 N·m"""
        K = {f"K{i + 1}": float(p[i]) * scale.K for i in range(3)}
        return {**K, "T1": self.T1 * scale.torque, "T2": self.T2 * scale.torque}


class FreeLines(Law):
    """Three lines whose knots are fitted too."""

    name, words = "fitted lines", "three lines with fitted knots"
    KNOTS = ((0.15, 0.45), (0.25, 0.75), (0.4, 0.7), (0.55, 0.85))  # shares of the largest torque a fit begins from

    def starts(self) -> list[list[float]]:
        """The secant, with several pairs of knots: the sum of squares has a valley for each bend."""
        return [[1.0, 1.0, 1.0, *knots] for knots in self.KNOTS]

    def torque(self, u: Array, p: Array, scale: Scale) -> Array:
        """K1 to T1, K2 to T2, K3 beyond."""
        return lines(u, np.maximum(p[:3], 0.02) * scale.K, self._knots(p) * scale.torque)

    def numbers(self, p: Array, scale: Scale) -> dict[str, float]:
        """K1, K2, K3 N·m/rad; T1, T2 N·m"""
        K = {f"K{i + 1}": float(p[i]) * scale.K for i in range(3)}
        T1, T2 = self._knots(p) * scale.torque
        return {**K, "T1": float(T1), "T2": float(T2)}

    @staticmethod
    def _knots(p: Array) -> Array:
        """In order, and apart."""
        first = max(float(p[3]), 0.02)
        return np.array([first, max(float(p[4]), first + 0.02)])
