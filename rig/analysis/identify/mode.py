"""ω_n and ζ of the free-free mode, with what their parts leave uncertain and how much of that they share.

Stiffness and inertia are found from the same windows of the same torque sensor: noise that makes one too large makes
the other too large, and leaves ω_n = √(K/M) nearly alone. Taken as independent they would make it four times as wide.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.dynamics import J_L, J_M, spring_columns
from rig.analysis.identify.fit import Fits
from rig.analysis.identify.solve import Solved, covariance_between
from rig.model.gearfile import Parameter

PARTS = ("J_m", "J_l", "K", "B_sp")


@dataclass(frozen=True)
class Part:
    """A parameter as a straight line of one fit's coefficients: gradient (p,)."""

    fit: Solved
    gradient: Array

    def covariance(self, other: Part) -> float:
        """With another, in the product of both units."""
        shared = self.fit.covariance if self.fit is other.fit else covariance_between(self.fit, other.fit)
        return float(self.gradient @ shared @ other.gradient)


def damping_gradient(fits: Fits) -> Array:
    """(p,) of B_sp by the coefficients of the spring's fit; a delay of the encoder passes for damping."""
    assert fits.spring is not None
    at_K, at_damping, at_delay, _ = spring_columns(fits.terms)
    c = fits.spring.coefficients
    gradient = np.zeros(c.size)
    gradient[[at_damping, at_delay]] = 1.0 / c[at_K]
    gradient[at_K] = -c[at_damping] / c[at_K] ** 2
    return gradient


def free_mode(p: Mapping[str, float], ratio: float) -> tuple[float, float]:
    """(ω_n rad/s, ζ) of inertia against inertia by way of the spring      [ghorbel2001, Eqs. 6-7]"""
    reflected = ratio**2 * p["J_m"]
    inertia = p["J_l"] * reflected / (p["J_l"] + reflected)
    omega = math.sqrt(p["K"] / inertia)
    return omega, p["B_sp"] / (2.0 * omega * inertia)


def add_mode(found: dict[str, Parameter], fits: Fits) -> None:
    """omega_n and zeta beside the parameters they are made of; nothing where those are not there."""
    if not {"J_m", "J_l", "K"} <= found.keys():
        return
    values = {name: found[name].value for name in PARTS}
    if not min(values[name] for name in ("J_m", "J_l", "K")) > 0.0:  # within its interval, which holds nothing to swing
        return
    ratio, halves = found["N"].value, np.array([_finite(found[name].half) for name in PARTS])
    best = np.array(free_mode(values, ratio))
    up = [free_mode({**values, name: values[name] + h}, ratio) for name, h in zip(PARTS, halves, strict=True)]
    by_part = np.array(up) - best  # (4, 2): by half an interval of each
    squares = np.einsum("ik,ij,jk->k", by_part, _correlations(fits, halves), by_part)
    for name, value, square, parts in zip(("omega_n", "zeta"), best, squares, (PARTS[:3], PARTS), strict=True):
        guessed = [part for part in parts if found[part].origin != "measured"]
        half = math.sqrt(square) if square > 0.0 and not guessed else math.nan
        origin = found[guessed[0]].origin if guessed else "measured"
        note = f"made with {', '.join(guessed)}, not determined by these runs" if guessed else ""
        found[name] = Parameter(float(value), (value - half, value + half), origin, found["K"].runs, note)


def _finite(half: float) -> float:
    return half if math.isfinite(half) else 0.0


def _correlations(fits: Fits, halves: Array) -> Array:
    """(4, 4) of PARTS; 0 between what was not measured together."""
    parts, size = _parts(fits), len(PARTS)
    found = np.eye(size)
    sigma = {name: max(math.sqrt(max(part.covariance(part), 0.0)), 1e-300) for name, part in parts.items()}
    for i in range(size):
        for j in range(size):
            a, b = PARTS[i], PARTS[j]
            if i != j and a in parts and b in parts and halves[i] and halves[j]:
                found[i, j] = parts[a].covariance(parts[b]) / (sigma[a] * sigma[b])
    return found


def _parts(fits: Fits) -> dict[str, Part]:
    """Those of PARTS that windows of turning runs have told."""
    parts: dict[str, Part] = {}
    if fits.motor is not None:
        parts["J_m"] = Part(fits.motor, np.eye(fits.motor.coefficients.size)[J_M])
    if fits.load is not None:
        parts["J_l"] = Part(fits.load, np.eye(fits.load.coefficients.size)[J_L])
    at_K = spring_columns(fits.terms)[0]
    if fits.spring is not None and fits.spring.coefficients[at_K] > 0.0:
        gradient = np.zeros(fits.spring.coefficients.size)
        gradient[at_K] = -1.0 / fits.spring.coefficients[at_K] ** 2
        parts["K"] = Part(fits.spring, gradient)
        parts["B_sp"] = Part(fits.spring, damping_gradient(fits))
    return parts
