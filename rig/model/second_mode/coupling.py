"""The spring of a coupling between the motor's encoder and the wave generator: the gear stands at θ_m − ψ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Port, Signals
from rig.model.second_mode.rates import following, rate
from rig.model.second_mode.shaken import shaken
from rig.model.waves import sums

Array = npt.NDArray[np.float64]

TURNS: Final = 5  # each leaves a twentieth
SMALL: Final = 1e-6  # rad: a twist by less has the tangent's slopes


def stiff(s: Signals, about: float) -> Mapping[Port, Array]:
    """One column: the twist under what the gear takes for 1 rad/(N·m), about a compliance of `about` rad/(N·m)."""
    through = through_it(s, about)
    lever, bend = twisted(s, about * through) if about else tangent(s)
    return {Port.KINEMATIC_ERROR: (lever * through)[:, None], Port.MOTOR_TORQUE: (s.torque * bend * through)[:, None]}


def sprung(s: Signals, about: float) -> Mapping[Port, Array]:
    """Six, for 1/k, J_2/k, b/k, c/k, d/k and J_2: the twist ψ = (T·lever + J_2·ω̇_w − b·(ω_m − ω_w) + c·f + d·ω_m)/k,
    where c is the share of the friction f that is the wave generator's, and d what it has more of the viscous one; and
    what the motor feels, J_2·(ω̇_w − ω̇_m). How the wave generator turns, ω_w, the load tells: there is no resonance in
    it that would make much of little errors.
    """

    def turned(whole: Signals) -> tuple[Array, ...]:
        omega, alpha = wave_generator(whole)
        return tuple(shaken(whole, x) for x in (alpha, omega - whole.omega_m, alpha - whole.alpha_m))

    alpha, behind, more = s.states(turned)
    through = through_it(s, about)
    friction = np.nan_to_num(s.tau_m - through - s.gear.J_m * s.alpha_m)
    lever, bend = twisted(s, about * through) if about else tangent(s)
    loads = np.stack([through, alpha, behind, friction, s.omega_m, np.zeros(lever.size)], 1)
    torque = (s.torque * bend)[:, None] * loads
    torque[:, 5] = more
    return {Port.KINEMATIC_ERROR: lever[:, None] * loads, Port.MOTOR_TORQUE: torque}


def wave_generator(s: Signals) -> tuple[Array, Array]:
    """Its speed and acceleration, rad/s and rad/s² (n,), as the load has them: θ_w = N·(θ_l + φ + θ̃_p(θ_w)), φ being
    the wind-up."""
    series, theta = s.gear.kinematic_error, s.theta_m
    wound = following(s.torque / s.gear.K, s.gear.B_sp / s.gear.K, s.dt)
    for _ in range(TURNS):
        (error,) = sums(series, theta, 0)
        theta = s.ratio * (s.theta_l + wound + error)
    between = rate(wound + error, s.dt)
    return s.ratio * (s.omega_l + between), s.ratio * (s.alpha_l + rate(between, s.dt))


def through_it(s: Signals, about: float) -> Array:
    """T times the lever at the wave generator's own angle, N·m."""
    straight = s.torque * s.lever
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
    return s.lever, s.series_bend
