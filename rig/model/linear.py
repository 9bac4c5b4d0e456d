"""What equations 6-7 say when the kinematic error is small: closed forms, the oracle of the plant and of the fits."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rig.model.gear import Gear


def effective_inertia(gear: Gear) -> float:
    """J_e = J_l·N²·J_m / (J_l + N²·J_m), kg·m² at the load, of the free-free mode."""
    reflected = gear.ratio**2 * gear.J_m
    return gear.J_l * reflected / (gear.J_l + reflected)


def held_frequency(K: float, J_l: float) -> float:
    """Of the load on the spring K [N·m/rad] while the motor is held or led, √(K/J_l) [rad/s]."""
    return float(np.sqrt(K / J_l))


def natural_frequency(gear: Gear) -> float:
    """ω_n = √(K / J_e), rad/s, both ends free."""
    return float(np.sqrt(gear.K / effective_inertia(gear)))


def damping_ratio(gear: Gear) -> float:
    """ζ = B_sp / (2·ω_n·J_e), of the free-free mode."""
    return gear.B_sp / (2.0 * natural_frequency(gear) * effective_inertia(gear))


def transmissibility(gear: Gear, order: npt.NDArray[np.float64], omega_m: float) -> npt.NDArray[np.complex128]:
    """θ̃_n / θ̃_p,n at constant motor torque: (1 + 2jζr)/(1 − r² + 2jζr), r = n·Ω/ω_n.

    `order` n (any shape), `omega_m` Ω rad/s. Base excitation of the torsional mode: follows from
    Eqs. 6-7 when θ̃_p′ is small against 1/N and friction is off      [ghorbel2001, Eqs. 6-7]
    """
    r = np.asarray(order) * omega_m / natural_frequency(gear)
    damping = 2j * damping_ratio(gear) * r
    return np.asarray((1.0 + damping) / (1.0 - r**2 + damping))
