"""The spring of a coupling between the motor's encoder and the wave generator: the gear stands at θ_m − ψ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Port, Signals
from rig.model.second_mode.swung import swung
from rig.model.waves import sums

Array = npt.NDArray[np.float64]

SMALL: Final = 1e-6  # rad: a twist by less has the tangent's slopes


def stiff(s: Signals, through: Array, about: float) -> Mapping[Port, Array]:
    """One column: the twist under `through` N·m (n,) for 1 rad/(N·m), about a compliance of `about` rad/(N·m)."""
    lever, bend = twisted(s, about * through) if about else tangent(s)
    return {Port.KINEMATIC_ERROR: (lever * through)[:, None], Port.MOTOR_TORQUE: (s.torque * bend * through)[:, None]}


def soft(s: Signals, omega: float, zeta: float, about: float) -> Mapping[Port, Array]:
    """Three: for 1/k, 1/ω² and J_2/ω², ψ = H_0·(τ/k + ω̇_m/ω²) being the twist; the motor feels −J_2·ψ̈."""

    def swinging(whole: Signals) -> tuple[Array, ...]:
        torque = through_it(whole, about)
        return (*swung(whole, torque, omega, zeta), *swung(whole, whole.alpha_m, omega, zeta))

    by_torque, jerk_t, by_alpha, jerk_a = s.states(swinging)
    lever, bend = twisted(s, about * by_torque + by_alpha / omega**2) if about else tangent(s)
    turned, twist, torque = s.torque * bend, np.zeros((lever.size, 3)), np.empty((lever.size, 3))
    twist[:, 0], twist[:, 1] = lever * by_torque, lever * by_alpha
    torque[:, 0], torque[:, 1], torque[:, 2] = turned * by_torque, turned * by_alpha - jerk_t, -jerk_a
    return {Port.KINEMATIC_ERROR: twist, Port.MOTOR_TORQUE: torque}


def through_it(s: Signals, about: float) -> Array:
    """T times the lever at the wave generator's own angle, N·m. Frequency and damping change nothing of it, and are
    tried many at a time: the last is kept.
    """
    last: dict[float, Array] = s.once("coupling", dict)
    through = last.get(about)
    if through is None:
        through = turned_by(s, about)
        last.clear()
        last[about] = through
    return through


def turned_by(s: Signals, about: float) -> Array:
    """The same, made afresh."""
    straight = s.torque * (1.0 / s.ratio - s.series_slope)
    if not about:
        return straight
    (slope,) = sums(s.gear.kinematic_error, s.theta_m - about * straight, 1)
    return s.torque * (1.0 / s.ratio - slope)


def twisted(s: Signals, psi: Array) -> tuple[Array, Array]:
    """Slopes of θ̃ and of its lever by the twist ψ rad (n,), secants from θ_m − ψ to θ_m: (1/N − Δθ̃_p/ψ, Δθ̃_p′/ψ)."""
    series, back = s.gear.kinematic_error, s.theta_m - psi
    small = np.abs(psi) < SMALL
    by, (value_back, slope_back) = np.where(small, 1.0, psi), sums(series, back, 0, 1)
    slope = np.where(small, s.series_slope, (s.series_value - value_back) / by)
    bend = np.where(small, s.series_bend, (s.series_slope - slope_back) / by)
    return 1.0 / s.ratio - slope, bend


def tangent(s: Signals) -> tuple[Array, Array]:
    """The same of a twist that is not known yet."""
    return 1.0 / s.ratio - s.series_slope, s.series_bend
