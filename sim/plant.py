"""The true gear: state, parameters and the passing of time, around the compiled kernel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from rig.core.errors import Exit, HdrigError, UsageError
from rig.model.gear import Gear
from sim import kernel
from sim.energy import Hidden, Ledger, potential
from sim.parameters import TwinParameters
from sim.vector import bristles, fastest_rate, pack, slips

FAILURES = {
    kernel.NOT_FINITE: "its state is no longer finite",
    kernel.TOO_FAST: f"it moves too fast to be followed in steps of {kernel.H_LEAST:g} s",
    kernel.CHATTER: f"it changed between stick and slip more than {kernel.MOST_EVENTS} times in one step",
}


FASTEST = kernel.C_MODE / kernel.H_LEAST  # 1/s; a gear with a faster rate needs shorter substeps than there are


class PlantFailure(HdrigError):
    """The simulated rig cannot be followed any further; never a finite but wrong answer. Its numbers are no gear's."""

    exit = Exit.USAGE


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

    What the paper's model lacks comes on top as `parameters.effects` says. Where load changes the kinematic error the
    balance is d(T+V)/dt + losses − work = (K·φ + B_sp·φ̇)·θ̃_p·ġ/g; the ledger has it as `schedule`.

    `refine` divides the substeps, for tests of convergence. Raises UsageError for a gear too stiff to be followed.
    """

    def __init__(self, parameters: TwinParameters, theta_m: float = 0.0, refine: float = 1.0) -> None:
        self.refine = refine
        self.tau_ext = 0.0  # N·m on the load, positive drives it forward
        self.locked = False  # output held fast, whatever the torque
        self._fit(parameters)
        self.place(theta_m)

    def _fit(self, parameters: TwinParameters) -> None:
        _refuse_too_fast(parameters.gear)
        self.parameters = parameters
        self.vector = pack(parameters, self.refine)
        self._pass = kernel.advance_full if parameters.effects.in_the_plant else kernel.advance
        elements = slips(parameters.effects.hysteresis) + bristles(parameters.effects.friction)
        self.state = np.zeros(kernel.STATE_SIZE + len(elements) // 2)

    def rebuild(self, parameters: TwinParameters) -> None:
        """Another gear around the same motor angle, at rest; time, warmth and wander stay."""
        stays = [kernel.THETA_M, kernel.WANDER_M, kernel.WANDER_L, kernel.WARMTH, kernel.CLOCK]
        theta_m, *rest = self.state[stays].tolist()
        self._fit(parameters)
        self.place(theta_m)
        self.state[stays[1:]] = rest

    def place(self, theta_m: float, omega_m: float = 0.0, twist: float = 0.0) -> None:
        """Put the motor at `theta_m` rad and `omega_m` rad/s, the load at its share of that speed, φ at `twist` rad.

        The energy ledger starts anew; the drive's torque is zero.
        """
        value, slope, per_load = kernel.kinematic_error(theta_m, 0.0, self.vector)
        ratio = self.parameters.gear.ratio
        self.state[:] = 0.0
        self.state[[kernel.THETA_M, kernel.OMEGA_M]] = theta_m, omega_m
        self.state[[kernel.THETA_L, kernel.OMEGA_L]] = theta_m / ratio - value + twist, omega_m * (1.0 / ratio - slope)
        self.state[[kernel.VALUE, kernel.SLOPE, kernel.PER_LOAD]] = value, slope, per_load
        self._start = self.energy()
        self.advance(0.0, 0.0)
        self.state[kernel.FILTERED] = self.state[kernel.TAU_L]
        self.advance(0.0, 0.0)

    def lock(self) -> None:
        """Hold the output fast where it is."""
        self.state[kernel.OMEGA_L] = 0.0
        self.locked = True

    def advance(self, dt: float, tau: float, xi_m: float = 0.0, xi_l: float = 0.0) -> None:
        """Let `dt` s pass with `tau` N·m asked of the drive; `xi` are the normal deviates of friction's wander.

        Raises PlantFailure when the state cannot be followed; it is then left as it was.
        """
        status, motor, load, shaft = self._pass(self.state, self.vector, dt, tau, self.tau_ext, self.locked, xi_m, xi_l)
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
        x, gear = self.truth(), self.parameters.gear
        moving = 0.5 * (gear.J_m * x.omega_m**2 + gear.J_l * x.omega_l**2)
        return moving + potential(self.parameters, x.theta_m, x.theta_l, x.phi, self.hidden())

    def hidden(self) -> Hidden:
        """The states behind the motion."""
        creep_1, creep_2 = self.state[[kernel.CREEP_1, kernel.CREEP_2]].tolist()
        return Hidden(creep_1, creep_2, tuple(self.state[kernel.STATE_SIZE :].tolist()))

    def ledger(self) -> Ledger:
        """Energy in, lost and stored since the start."""
        entries = self.state[kernel.IN_MOTOR : kernel.IN_SCHEDULE + 1].tolist()
        return Ledger(*[*entries, self.energy() - self._start])


def _refuse_too_fast(gear: Gear) -> None:
    rate = fastest_rate(gear)
    if not rate <= FASTEST:  # NaN too
        raise UsageError(
            f"the twin cannot follow a gear of K = {gear.K:g} N·m/rad, J_m = {gear.J_m:g} kg·m², J_l = {gear.J_l:g} "
            f"kg·m², B_m = {gear.B_m:g}, B_sp = {gear.B_sp:g}, B_l = {gear.B_l:g} N·m·s/rad: its fastest rate is "
            f"{rate:.3g} 1/s, expected at most {FASTEST:.3g} 1/s"
        )
