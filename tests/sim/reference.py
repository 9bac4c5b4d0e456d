"""The plant a second time, slowly and by other means: generalised forces of Lagrange and Rayleigh, DOP853."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

from rig.model.gear import Gear

Array = npt.NDArray[np.float64]


def forces(gear: Gear, q: Array, qdot: Array, slides: tuple[float, float]) -> Array:
    """−∂V/∂q − ∂D/∂q̇ − friction of the sides that slide (±1, 0: at rest), for q = (θ_m, θ_l); N·m."""
    theta = np.array(q[0])
    phi = q[1] - q[0] / gear.ratio + gear.kinematic_error.value(theta)
    gradient = np.array([gear.kinematic_error.slope(theta) - 1.0 / gear.ratio, 1.0])  # ∂φ/∂q
    slip = np.array([1.0, gear.sigma])
    torque = -gradient * (gear.K * phi + gear.B_sp * (gradient @ qdot))
    torque = torque - np.array([gear.B_m, gear.B_l]) * qdot - gear.B_ml * slip * (slip @ qdot)
    level = np.array([gear.tau_c + (gear.tau_s - gear.tau_c) * np.exp(-((qdot[0] / gear.omega_s) ** 2)), gear.F_cl])
    return torque - np.asarray(slides) * level


def sliding(
    gear: Gear, start: Array, times: Array, tau: float, lag: float, tau_drive: float, tau_ext: float = 0.0
) -> Array:
    """States (θ_m, θ_l, ω_m, ω_l) at `times` s, shape (n, 4), while both sides slide forward all the time."""
    inertia = np.array([gear.J_m, gear.J_l])

    def rate(t: float, x: Array) -> Array:
        applied = np.array([tau + lag * np.exp(-t / tau_drive), tau_ext])
        return np.concatenate([x[2:], (applied + forces(gear, x[:2], x[2:], (1.0, 1.0))) / inertia])

    found = solve_ivp(rate, (0.0, times[-1]), start, "DOP853", t_eval=times, rtol=1e-13, atol=1e-14, max_step=2e-3)
    assert found.success
    assert np.all(found.y[2:] > 0.0)
    return np.asarray(found.y.T)
