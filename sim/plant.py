"""The true gear: state, parameters and the passing of time, around the compiled kernel."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from rig.core.errors import HdrigError
from rig.model.gear import Gear
from rig.model.linear import damping_ratio, natural_frequency
from sim import kernel
from sim.energy import Ledger, stored
from sim.parameters import TwinParameters

AT_ONCE = 1e-9  # s, what a drive without delay takes: nothing on the scale of a substep
FAILURES = {
    kernel.NOT_FINITE: "its state is no longer finite",
    kernel.TOO_FAST: f"it moves too fast to be followed in steps of {kernel.H_LEAST:g} s",
    kernel.CHATTER: f"it changed between stick and slip more than {kernel.MOST_EVENTS} times in one step",
}


class PlantFailure(HdrigError):
    """The simulated rig cannot be followed any further; never a finite but wrong answer."""


class Truth(NamedTuple):
    """What really happens in the twin, SI, for tests. A held side has a speed of exactly zero."""

    theta_m: float
    omega_m: float
    theta_l: float
    omega_l: float
    phi: float  # rad at the output, θ_l − θ_m/N + θ̃_p
    tau_m: float  # N·m, motor torque behind the drive's torque loop
    tau_l: float  # N·m, what the gear gives to the load


class Plant:
    """Two inertias, a spring with kinematic error, viscous terms, true sticking      [ghorbel2001, Eqs. 6-7]

    J_m·ω̇_m = τ_m − (K·φ + B_sp·φ̇)(θ̃_p′ − 1/N) − B_m·ω_m − B_ml·(ω_m + σ·ω_l) − τ_f
    J_l·ω̇_l = τ_l + τ_ext − B_l·ω_l − F_l,   τ_l = −K·φ − B_sp·φ̇ − σ·B_ml·(ω_m + σ·ω_l)

    τ_ext stands beside the paper's Eq. 7, positive when it drives the load forward. Friction stands beside both:
    τ_f = (τ_c + (τ_s − τ_c)·exp(−(ω_m/ω_s)²))·sgn ω_m and F_l = F_cl·sgn ω_l while sliding; at rest whatever is
    needed, up to τ_s and F_cl      [armstrong1994] [karnopp1985]

    `refine` divides the substeps, for tests of convergence.
    """

    def __init__(self, parameters: TwinParameters, theta_m: float = 0.0, refine: float = 1.0) -> None:
        self.parameters = parameters
        self.vector = pack(parameters, refine)
        self.state = np.zeros(kernel.STATE_SIZE)
        self.tau_ext = 0.0  # N·m on the load, positive drives it forward
        self.locked = False  # output held fast, whatever the torque
        self.place(theta_m)

    def place(self, theta_m: float, omega_m: float = 0.0, twist: float = 0.0) -> None:
        """Put the motor at `theta_m` rad and `omega_m` rad/s, the load at its share of that speed, φ at `twist` rad.

        The energy ledger starts anew; the drive's torque is zero.
        """
        value, slope = kernel.kinematic_error(theta_m, self.vector)
        ratio = self.parameters.gear.ratio
        self.state[:] = 0.0
        self.state[[kernel.THETA_M, kernel.OMEGA_M]] = theta_m, omega_m
        self.state[[kernel.THETA_L, kernel.OMEGA_L]] = theta_m / ratio - value + twist, omega_m * (1.0 / ratio - slope)
        self.state[[kernel.VALUE, kernel.SLOPE]] = value, slope
        self._start = self.energy()
        self.advance(0.0, 0.0)
        self.state[kernel.FILTERED] = self.state[kernel.TAU_L]
        self.advance(0.0, 0.0)

    def advance(self, dt: float, tau: float, xi_m: float = 0.0, xi_l: float = 0.0) -> None:
        """Let `dt` s pass with `tau` N·m asked of the drive; `xi` are the normal deviates of friction's wander.

        Raises PlantFailure when the state cannot be followed; it is then left as it was.
        """
        status, motor, load, shaft = kernel.advance(
            self.state, self.vector, dt, tau, self.tau_ext, self.locked, xi_m, xi_l
        )
        if status:
            raise PlantFailure(f"the twin's plant has failed: {FAILURES[status]} ({self.truth()}, {tau:g} N·m asked)")
        self.motor, self.load, self.shaft = motor, load, shaft

    def truth(self) -> Truth:
        """The state now."""
        theta_m, omega_m, theta_l, omega_l, tau_m, tau_l = self.state[: kernel.TAU_L + 1].tolist()
        phi = theta_l - theta_m / self.parameters.gear.ratio + float(self.state[kernel.VALUE])
        return Truth(theta_m, omega_m, theta_l, omega_l, phi, tau_m, tau_l)

    def energy(self) -> float:
        """T + V now [J]."""
        x = self.truth()
        return stored(self.parameters.gear, x.omega_m, x.omega_l, x.phi)

    def ledger(self) -> Ledger:
        """Energy in, lost and stored since the start."""
        entries = self.state[kernel.IN_MOTOR : kernel.LOST_LOAD + 1].tolist()
        return Ledger(*[*entries, self.energy() - self._start])


def pack(parameters: TwinParameters, refine: float) -> npt.NDArray[np.float64]:
    """The kernel's parameter vector."""
    gear = parameters.gear
    a, b, n = np.asarray(gear.kinematic_error.a), np.asarray(gear.kinematic_error.b), gear.kinematic_error.orders
    numbers: dict[int, float] = {
        kernel.PER_N: 1.0 / gear.ratio,
        kernel.PER_J_M: 1.0 / gear.J_m,
        kernel.PER_J_L: 1.0 / gear.J_l,
        kernel.K: gear.K,
        kernel.B_M: gear.B_m,
        kernel.B_L: gear.B_l,
        kernel.B_ML: gear.B_ml,
        kernel.B_SP: gear.B_sp,
        kernel.SIGMA: gear.sigma,
        kernel.TAU_C: gear.tau_c,
        kernel.TAU_S: gear.tau_s,
        kernel.PER_OMEGA_S: 1.0 / gear.omega_s,
        kernel.F_CL: gear.F_cl,
        kernel.T_DRIVE: max(parameters.tau_drive, AT_ONCE),
        kernel.T_SENSOR: 1.0 / (2.0 * math.pi * parameters.sensor_lowpass_hz),
        kernel.WANDER: parameters.friction_noise,
        kernel.T_WANDER: parameters.friction_noise_s,
        kernel.MODE_RATE: fastest_rate(gear),
        kernel.TERMS: len(n),
        kernel.REFINE: refine,
    }
    head = [numbers[place] for place in range(kernel.SERIES)]
    return np.concatenate([head, np.stack([a, b, n * a, n * b], axis=1).ravel()])


def fastest_rate(gear: Gear) -> float:
    """The fastest linear rate [1/s]: the torsional mode's frequency, its damping, the drag of either side."""
    damping = 2.0 * damping_ratio(gear) * natural_frequency(gear)
    return max(natural_frequency(gear), damping, (gear.B_m + gear.B_ml) / gear.J_m, (gear.B_l + gear.B_ml) / gear.J_l)
