"""How hard the torsional mode is shaken at a given speed: what a run open loop does to the shaft, before it is run."""

from __future__ import annotations

import numpy as np

from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import transmissibility

GRID = 1024  # angles a turn at which the swing is looked for: 68 per period of order 15
STEPS = 400  # speeds looked at on the way up: 1.5 rpm apart at 600 rpm; the resonance of order 2 is 60 rpm wide


def predicted_swing(gear: Gear, series: FourierSeries, omega_m: float) -> float:
    """How far the shaft torque swings either way of its mean at constant motor torque, N·m, zero to peak.

    `series` is the pure kinematic error (rad at the output), `omega_m` the mean motor speed rad/s of either sign.
    τ_l,n = (K + j·n·Ω·B_sp)·θ̃_s,n with θ̃_s,n = (T_n − 1)·θ̃_p,n, summed over the orders with their phases. Linear: at a
    resonance the real rig swings a little less, because its mean speed gives way      [ghorbel2001, Eqs. 2, 6-7]
    """
    n = series.orders
    pure = np.asarray(series.a) - 1j * np.asarray(series.b)  # θ̃_p = Re Σ pure_n·exp(jnθ)
    torque = (gear.K + 1j * n * omega_m * gear.B_sp) * (transmissibility(gear, n, omega_m) - 1.0) * pure
    angle = np.linspace(0.0, 2.0 * np.pi, GRID, endpoint=False)
    return float(np.max(np.abs(np.real(np.exp(1j * np.multiply.outer(angle, n)) @ torque)), initial=0.0))


def worst_swing(gear: Gear, series: FourierSeries, omega_m: float) -> tuple[float, float]:
    """(swing N·m, at which speed rad/s): the largest `predicted_swing` on the way from rest up to `omega_m` rad/s.

    A run passes every resonance below its speed; passing quickly swings less than this, which is for staying there.
    """
    speeds = np.linspace(0.0, omega_m, STEPS + 1)[1:]
    swings = [predicted_swing(gear, series, float(omega)) for omega in speeds]
    worst = int(np.argmax(swings))
    return swings[worst], float(speeds[worst])
