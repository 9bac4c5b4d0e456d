"""A run at speed taken apart: θ̃ measured, θ̃_p of the slow run, what is left, and the same of the model."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rig.analysis.at_speed.decomposition import Decomposition, decompose
from rig.analysis.findings.result import Array
from rig.analysis.findings.unbiased import phasor_draws, unbiased
from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.kinematic_error.profile import DRAWS, Profile
from rig.analysis.orders.revolutions import GRID
from rig.analysis.orders.wave import wave
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Number
from rig.analysis.reproduction.model import Model
from rig.analysis.reproduction.reading import Reading
from rig.analysis.reproduction.shaft import Complex, Shaft
from rig.core.units import ARCSEC, RPM
from rig.model.gear import Gear
from rig.model.simulate import NoSteadyState, at_speed

THETA_DEG = (np.arange(GRID) + 0.5) / GRID * 360.0


@dataclass(frozen=True)
class Split:
    """Phasors (k,) of Re Σ z_n·exp(jnθ_m), arcsec at the output; `u` (k,) 1 σ of one part, total − pure."""

    reading: Reading
    fast: KinematicError
    decomposition: Decomposition
    simulated: Complex | None  # θ̃ of the model, None where there is none or it does not turn steadily
    simulated_pure: Complex | None
    torque: float  # N·m the model needs for that speed

    @property
    def total(self) -> Complex:
        """θ̃ measured."""
        return self.decomposition.total

    @property
    def left(self) -> Complex | None:
        """θ̃ measured less that of the model."""
        return None if self.simulated is None else self.total - self.simulated

    def rms_left(self) -> Number | None:
        """rms over the turn of what the model leaves of θ̃, arcsec."""
        if self.left is None:
            return None
        return rms(self.left, _u_fast(self.fast.profile, self.total.size), self.decomposition.factor)


def split_of(campaign: Campaign, rpm: float) -> Split | None:
    """The run at about `rpm`; None without it or without a slow run it agrees with."""
    reading, pure = campaign.at_speed(rpm), campaign.pure()
    if reading is None or reading.fast is None or pure is None:
        return None
    parts = decompose(reading, reading.fast, pure[1].profile)
    if parts is None:
        return None
    made = None if campaign.model is None else simulate(campaign.model.gear, reading.fast, parts)
    if made is None:
        return Split(reading, reading.fast, parts, None, None, float("nan"))
    return Split(reading, reading.fast, parts, *made)


def simulate(gear: Gear, fast: KinematicError, parts: Decomposition) -> tuple[Complex, Complex, float] | None:
    """(θ̃, θ̃_p, torque N·m) of the gear turning steadily at constant torque with the speed that was measured."""
    way = float(np.sign(fast.strokes[0].direction))
    try:
        made = at_speed(gear, way * fast.speed_rpm * RPM)
    except NoSteadyState:
        return None
    k = parts.total.size
    turned = np.exp(-1j * np.arange(1.0, k + 1) * parts.alignment.shift) / ARCSEC
    total, pure = (np.conj(made.orders(c, k)) * turned for c in (made.kinematic_error, made.pure))
    return np.asarray(total), np.asarray(pure), made.tau


def bending(shaft: Shaft, model: Model, fast: KinematicError, terms: int) -> Complex:
    """θ̃_s,n = τ_l,n/(K + jnΩ·B_sp), arcsec: what the spring bends by the torque sensor      [ghorbel2001, Eq. 7]"""
    n = np.arange(1.0, min(terms, shaft.orders.size) + 1)
    omega = fast.speed_rpm * RPM * float(np.sign(fast.strokes[0].direction))
    gear = model.gear
    found = np.zeros(terms, dtype=np.complex128)
    found[: n.size] = shaft.orders[: n.size] / (gear.K + 1j * n * omega * gear.B_sp) / ARCSEC
    return found


def rms(phasor: Complex, u: Array, factor: float) -> Number:
    """rms over a turn, arcsec, freed of what noise adds; Monte Carlo from 1 σ `u` of every part      [gum]"""
    return _drawn(lambda z: float(np.sqrt(0.5 * np.sum(np.abs(z) ** 2))), phasor, u, factor, "arcsec")


def share(left: Complex, of: Complex, u: Array, factor: float) -> Number:
    """rms of `left` over rms of `of`; the noise of the measurement is in the first."""
    size = float(np.sqrt(0.5 * np.sum(np.abs(of) ** 2)))
    number = rms(left, u, factor)
    return Number(number.value / size, number.low / size, number.high / size, "1")


def swing(phasor: Complex, u: Array, factor: float) -> Number:
    """Peak to peak over a turn, arcsec, freed of what noise adds."""
    return _drawn(lambda z: float(np.ptp(wave(z))), phasor, u, factor, "arcsec")


def _drawn(size: Callable[[Complex], float], phasor: Complex, u: Array, factor: float, unit: str) -> Number:
    sizes = np.array([size(phasor + u * draw) for draw in phasor_draws(DRAWS, u.size)])
    value, scatter = unbiased(size(phasor), sizes)
    half = factor * scatter
    return Number(value, max(value - half, 0.0), value + half, unit)


def _u_fast(p: Profile, k: int) -> Array:
    """1 σ of one part of each phasor of the run at speed, (k,)."""
    return np.asarray(np.sqrt(0.5 * (p.u_cosine[:k] ** 2 + p.u_sine[:k] ** 2) + p.u_system[:k] ** 2))


def peak_to_peak(error: KinematicError) -> Number:
    """Of the fitted series, arcsec."""
    value, (low, high) = error.profile.peak_to_peak()
    return Number(value, low, high, "arcsec")


def amplitude(error: KinematicError, n: int) -> Number:
    """Of order n, arcsec."""
    p = error.profile
    return Number.of(float(p.amplitude[n - 1]), p.factor * float(p.u_amplitude[n - 1]), "arcsec")


def words(reading: Reading, error: KinematicError) -> str:
    """Which run, how many turns of it, how fast."""
    p = error.profile
    return f"{reading.name}, {p.forward + p.reverse} turns at {error.speed_rpm:.1f} rpm"
