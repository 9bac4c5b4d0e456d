"""The paper's slow run, plant and position loop alone: by hdrig's kernel, and by a C floor of the same equations."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numba import njit

from rig.analysis.findings.result import Array
from rig.bench import read, twin_parameters
from rig.core.gains import Gains
from sim import kernel
from sim.parameters import TwinParameters
from sim.plant import Plant
from tests.bench.built import floor

TERMS = 64  # room in the floor's record
AMPLITUDE, PERIOD = 8.0 * np.pi, 100.0  # rad and s: ±1440° at 0.01 Hz      [ghorbel2001]


class Rig(ctypes.Structure):
    """The floor's record, in its order."""

    _fields_ = [
        *((name, ctypes.c_double) for name in ("ratio", "J_m", "J_l", "K", "B_m", "B_l", "B_ml", "B_sp", "sigma")),
        *((name, ctypes.c_double) for name in ("tau_c", "tau_s", "omega_s", "F_cl", "T_drive")),
        *((name, ctypes.c_double) for name in ("Kp", "Ki", "Kd", "ff", "limit")),
        ("terms", ctypes.c_long),
        ("a", ctypes.c_double * TERMS),
        ("b", ctypes.c_double * TERMS),
    ]


@dataclass(frozen=True)
class SlowRun:
    """`n` ticks of 1 ms; friction does not wander: both sides then have the same equations and no chance in them."""

    parameters: TwinParameters
    gains: Gains
    theta_ref: Array
    omega_ref: Array
    speed: float = 0.0  # rad/s of the motor at the start, the spring then wound as friction of the load wants it
    refine: float = 1.0  # divides our substeps

    @classmethod
    def steady(cls, ticks: int, speed: float, stiffer: float) -> SlowRun:
        """`ticks` at `speed` rad/s from the start on, with a spring `stiffer` times as stiff: nothing ever stops."""
        slow = cls.of(ticks / 1000.0)
        gear = replace(slow.parameters.gear, K=stiffer * slow.parameters.gear.K)
        theta = speed * np.arange(ticks) / 1000.0
        return cls(replace(slow.parameters, gear=gear), slow.gains, theta, np.full(ticks, speed), speed)

    @classmethod
    def of(cls, seconds: float) -> SlowRun:
        """The rig of benches/twin.toml."""
        bench = read("twin")
        t = np.arange(round(seconds * 1000)) / 1000.0
        phase = t / PERIOD % 1.0
        up = (phase < 0.25) | (phase >= 0.75)
        theta = 4.0 * AMPLITUDE * np.where(phase < 0.25, phase, np.where(phase < 0.75, 0.5 - phase, phase - 1.0))
        speed = np.where(up, 1.0, -1.0) * 4.0 * AMPLITUDE / PERIOD
        return cls(replace(twin_parameters(bench.file), friction_noise=0.0), bench.gains, theta, speed)

    def plant(self) -> Plant:
        """Where the run begins; relaxed when it stands."""
        plant, gear = Plant(self.parameters, refine=self.refine), self.parameters.gear
        if self.speed:
            plant.place(0.0, self.speed, -(gear.F_cl + gear.B_l * self.speed / gear.ratio) / gear.K)
        return plant

    def start(self) -> Array:
        """The same for a solver: θ_m, ω_m, θ_l, ω_l."""
        x = self.plant().truth()
        return np.array([x.theta_m, x.omega_m, x.theta_l, x.omega_l])

    def question(self) -> dict[str, Any]:
        """The same for a peer in another process."""
        gear, g = self.parameters.gear, self.gains
        names = ("ratio", "J_m", "J_l", "K", "B_m", "B_l", "B_ml", "B_sp", "sigma", "tau_c", "tau_s", "omega_s", "F_cl")
        return {
            "gear": {name: getattr(gear, name) for name in names} | {"T_drive": self.parameters.tau_drive},
            "a": list(gear.kinematic_error.a),
            "b": list(gear.kinematic_error.b),
            "gains": {"Kp": g.Kp, "Ki": g.Ki, "Kd": g.Kd, "ff": g.feedforward},
            "speed": self.speed,
            "ticks": self.theta_ref.size,
            "start": self.start().tolist(),
        }

    def by_kernel(self) -> Array:
        """θ_m/N − θ_l [rad] at every tick."""
        plant, g = self.plant(), self.gains
        gains = (g.Kp, g.Ki, g.Kd, g.feedforward, g.torque_limit)
        return np.asarray(ticks(plant.state, plant.vector, self.theta_ref, self.omega_ref, gains))

    def by_floor(self, *flags: str, sub: int = 1) -> Callable[[], Array]:
        """The same by C, `sub` steps a tick. Raises Unavailable."""
        library, record = floor("plant", *flags), self._record()
        library.tabulate(ctypes.byref(record))
        run: Any = library.run

        def once() -> Array:
            y, out = self.start(), np.empty(self.theta_ref.size)
            places = [x.ctypes.data_as(ctypes.c_void_p) for x in (self.theta_ref, self.omega_ref, y, out)]
            run(ctypes.byref(record), ctypes.c_long(out.size), ctypes.c_double(1e-3), ctypes.c_long(sub), *places)
            return out

        return once

    def _record(self) -> Rig:
        gear, g, record = self.parameters.gear, self.gains, Rig()
        for name in ("ratio", "J_m", "J_l", "K", "B_m", "B_l", "B_ml", "B_sp", "sigma"):
            setattr(record, name, getattr(gear, name))
        for name in ("tau_c", "tau_s", "omega_s", "F_cl"):
            setattr(record, name, getattr(gear, name))
        record.T_drive, record.terms = self.parameters.tau_drive, len(gear.kinematic_error.a)
        record.Kp, record.Ki, record.Kd, record.ff, record.limit = g.Kp, g.Ki, g.Kd, g.feedforward, g.torque_limit
        for n, (a, b) in enumerate(zip(gear.kinematic_error.a, gear.kinematic_error.b, strict=True)):
            record.a[n], record.b[n] = a, b
        return record


@njit
def ticks(state: Array, p: Array, theta_ref: Array, omega_ref: Array, gains: tuple[float, ...]) -> Array:
    """The kernel under the floor's position loop."""
    Kp, Ki, Kd, ff, limit = gains
    integral, per_n = 0.0, p[kernel.PER_N]
    out = np.empty(theta_ref.size)
    for k in range(theta_ref.size):
        e = theta_ref[k] - state[kernel.THETA_M]
        integral += Ki * e * 1e-3
        tau = Kp * e + integral + Kd * (omega_ref[k] - state[kernel.OMEGA_M]) + ff * omega_ref[k]
        kernel.advance(state, p, 1e-3, min(max(tau, -limit), limit), 0.0, False, 0.0, 0.0)
        out[k] = state[kernel.THETA_M] * per_n - state[kernel.THETA_L]
    return out
