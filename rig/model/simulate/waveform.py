"""One turn of the wave generator in the steady state, as arrays over its angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.core.errors import Exit, HdrigError

Array = npt.NDArray[np.float64]


class NoSteadyState(HdrigError):
    """The gear does not turn steadily under this torque."""

    exit = Exit.USAGE


@dataclass(frozen=True)
class Waveform:
    """All arrays (M,) over `theta_m` rad, M equal steps from 0 to just before one turn; angles rad at the output."""

    theta_m: Array
    omega_m: Array  # rad/s
    omega_l: Array  # rad/s
    pure: Array  # θ̃_p
    flexible: Array  # θ̃_s = −φ
    spring_torque: Array  # K·θ̃_s, N·m, positive when the spring drives the load forward
    shaft_torque: Array  # τ_l, all the gear gives to the load, N·m
    tau: float  # N·m at the motor
    tau_ext: float  # N·m on the load
    mean_speed: float  # rad/s of the motor, mean over time

    @property
    def kinematic_error(self) -> Array:
        """θ̃ = θ̃_p + θ̃_s      [ghorbel2001, Eq. 2]"""
        return self.pure + self.flexible

    @property
    def time(self) -> Array:
        """s since θ_m = 0, (M,): trigonometric integration of 1/ω_m over the angle."""
        slowness = np.fft.rfft(1.0 / self.omega_m)
        order = np.arange(slowness.size)
        slowness[1:] /= 1j * order[1:]
        mean = float(slowness[0].real) / self.theta_m.size
        slowness[0] = 0.0
        ripple = np.fft.irfft(slowness, self.theta_m.size)
        return np.asarray(mean * self.theta_m + ripple - ripple[0])

    def orders(self, curve: Array, most: int) -> npt.NDArray[np.complex128]:
        """Σ_n Re(c_n·e^{−jnθ}): c_n = a_n + j·b_n of a curve (M,), orders 1..most, in the curve's unit."""
        return np.asarray(2.0 / self.theta_m.size * np.conj(np.fft.rfft(curve)[1 : most + 1]))
