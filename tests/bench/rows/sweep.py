"""Row 6: many rigs."""

from __future__ import annotations

import ctypes
from dataclasses import replace
from typing import Any, ClassVar, final

import numpy as np
from numba import njit

from rig.analysis.findings.result import Array
from rig.model.gear import Gear
from rig.model.simulate import each_under_torque
from sim import kernel
from sim.plant import Plant
from tests.bench.built import Unavailable, floor
from tests.bench.figure import AtMost, Figure, Shown, not_measured, ratio
from tests.bench.row import Row
from tests.bench.slow_run import SlowRun
from tests.bench.turns import Rounds, Side, cpu, take_turns
from tests.bench.worker import Worker

SPEED, TAU = 10.0, 0.45  # rad/s at the start, N·m held: both sides slide forward all the time
COMMON = ("ratio", "J_m", "B_m", "B_l", "B_ml", "B_sp", "sigma", "tau_s", "omega_s", "F_cl")


class Common(ctypes.Structure):
    """The floor's record: what all rigs share."""

    _fields_ = (
        *((name, ctypes.c_double) for name in COMMON),
        ("terms", ctypes.c_long),
        ("a", ctypes.c_double * 64),
        ("b", ctypes.c_double * 64),
    )


@njit
def advanced(states: Array, vectors: Array, tau: float, ticks: int) -> None:
    """Every rig `ticks` ms further by the twin's kernel, one after the other."""
    for r in range(states.shape[0]):
        for _ in range(ticks):
            kernel.advance(states[r], vectors[r], 1e-3, tau, 0.0, False, 0.0, 0.0)


class Rigs:
    """`count` rigs around the bench's: K, J_l and τ_c a tenth either way, spread evenly."""

    def __init__(self, count: int) -> None:
        self.base = SlowRun.steady(1, SPEED, 1.0)
        self.gear = self.base.parameters.gear
        x = np.linspace(0.9, 1.1, count)
        self.K, self.J_l, self.tau_c = self.gear.K * x, self.gear.J_l * x[::-1].copy(), self.gear.tau_c * x
        varied = zip(self.K.tolist(), self.J_l.tolist(), self.tau_c.tolist(), strict=True)
        self.gears = [replace(self.gear, K=K, J_l=J_l, tau_c=tau_c) for K, J_l, tau_c in varied]
        plants = [self._plant(gear) for gear in self.gears]
        self.states, self.vectors = (np.stack([getattr(p, n) for p in plants]) for n in ("state", "vector"))
        self.y = np.ascontiguousarray(self.states[:, [kernel.THETA_M, kernel.OMEGA_M, kernel.THETA_L, kernel.OMEGA_L]])

    def _plant(self, gear: Gear) -> Plant:
        at_once = replace(self.base.parameters, gear=gear, tau_drive=0.0)
        return replace(self.base, parameters=at_once).plant()

    def by_sweep(self, ticks: int) -> Array:
        """θ_m of each [rad], by `rig.model.simulate`."""
        t, tau = np.array([0.0, 1e-3 * ticks]), np.full(2, TAU)
        return np.asarray(each_under_torque(self.gears, t, tau, start=self.y.T).theta_m[:, -1])

    def by_kernel(self, ticks: int) -> Array:
        """The same, by the twin's plant."""
        states = self.states.copy()
        advanced(states, self.vectors.copy(), TAU, ticks)
        return np.asarray(states[:, kernel.THETA_M])

    def by_floor(self, ticks: int) -> Array:
        """The same, 8 rigs at once. Raises Unavailable."""
        record, library = (
            Common(*(getattr(self.gear, name) for name in COMMON)),
            floor("sweep", "-ffast-math", "-fopenmp"),
        )
        series = self.gear.kinematic_error
        record.terms = len(series.a)
        for n, (a, b) in enumerate(zip(series.a, series.b, strict=True)):
            record.a[n], record.b[n] = a, b
        y = np.ascontiguousarray(self.y.T)
        K, J_l, tau_c, out = (x.ctypes.data_as(ctypes.c_void_p) for x in (self.K, self.J_l, self.tau_c, y))
        size, h = ctypes.c_long(self.K.size), ctypes.c_double(1e-3)
        library.sweep(ctypes.byref(record), size, K, J_l, tau_c, ctypes.c_double(TAU), ctypes.c_long(ticks), h, out)
        return np.asarray(y[0])

    def question(self, ticks: int) -> dict[str, Any]:
        """The same for jax."""
        lists = {"K": self.K, "J_l": self.J_l, "tau_c_of": self.tau_c, "state": self.y}
        return self.base.question() | {name: x.tolist() for name, x in lists.items()} | {"ticks": ticks, "tau": TAU}


@final
class Sweep(Row):
    """Both sides slide all the time: that is all that floor and jax can follow; ours looks for rest and reversal too.

    Found: the twin's kernel one rig at a time, with its ledger of energy and its search for events, cost eleven times
    the floor. A kernel with the rigs innermost costs as much as C; what it took is that nothing in its loops can branch
    or alias (one array at fixed offsets, no check for division by zero, polynomials for sine, cosine and exponential).
    """

    number: ClassVar[int] = 6
    name: ClassVar[str] = "sweep of 1000 rigs"
    against: ClassVar[str] = "C OpenMP with SIMD across sets; jax vmap"

    def measure(self, rounds: Rounds) -> list[Figure]:
        rigs, ticks = Rigs(rounds.size(1000, 96)), rounds.size(500, 100)
        sides: dict[str, Side] = {
            "ours": cpu(lambda: rigs.by_sweep(ticks)),
            "kernel": cpu(lambda: rigs.by_kernel(ticks)),
            "floor": cpu(lambda: rigs.by_floor(ticks)),
        }
        apart = float(np.max(np.abs(rigs.by_sweep(ticks) - rigs.by_floor(ticks))))
        why = ""
        try:
            with Worker("sweep") as peer:
                question = rigs.question(ticks)
                found = take_turns(sides | {"jax": lambda: float(peer.ask(**question)["cpu"])}, min(rounds.count, 5))
        except Unavailable as absent:
            why, found = str(absent), take_turns(sides, rounds.count)
        name, target = "CPU time over jax vmap", AtMost(0.5)
        return [
            ratio("CPU time over C", found["ours"], found["floor"], AtMost(2.5)),
            not_measured(name, target, why) if why else ratio(name, found["ours"], found["jax"], target),
            ratio("the twin's plant, rig by rig, CPU time over C", found["kernel"], found["floor"], Shown()),
            Figure("largest difference of a motor angle from C's", [apart], Shown(), "rad"),
        ]
