"""A locked gear of formulas: wound up and down at several rates with holds; spring, slipping elements, drag, creep."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.model.fourier import FourierSeries
from tests.analysis.synthetic import MadeRun, count

Array = npt.NDArray[np.float64]
N, K = 50.0, 7160.0  # ratio; N·m/rad
QUARTER, HOLD = 20.0, 2.0  # s at the first rate; s
CREEP_TIMES = 10.0 ** np.arange(-3, 4)  # s, one Maxwell element a decade


def linear(u: Array) -> Array:
    return K * u


@dataclass(frozen=True)
class LockedGear:
    """Torque [N·m] from wind-up: spring(u) + Σ slipping + drag·u̇ + a chain that creeps."""

    spring: Callable[[Array], Array] = linear
    slip: tuple[tuple[float, float], ...] = ()  # (stiffness N·m/rad, torque at which it slips N·m)
    drag: float = 0.0  # N·m·s/rad at the output
    creep: float = 0.0  # N·m/rad of each element of the chain
    error: FourierSeries | None = None
    error_share: float = 1.0  # of it that the loaded gear shows
    reach: float = 15.0 / K  # rad, how far it is wound up
    cycles: int = 3
    rates: tuple[float, ...] = (1.0, 0.3, 3.0)
    noise: float = 0.03  # N·m
    zero: float = 0.04  # N·m, sensor offset
    home: float = 0.3  # rad, motor angle where the wind-up is 0
    rate: float = 50.0  # Hz
    slips: int = 0  # steps the motor goes from end to end in; 0: it never sticks

    def time_and_windup(self) -> tuple[Array, Array]:
        """0 → +reach → −reach → … → 0, held at the ends."""
        t, w = [0.0, 1.0], [0.0, 0.0]
        for k, share in enumerate(self.rates):
            for _ in range(self.cycles if k == 0 else 1):
                for end in (self.reach, -self.reach):
                    t.append(t[-1] + abs(end - w[-1]) / self.reach * QUARTER / share)
                    w.append(end)
                    t.append(t[-1] + HOLD)
                    w.append(end)
        t.append(t[-1] + QUARTER)
        w.append(0.0)
        grid = np.arange(0.0, t[-1], 1.0 / self.rate)
        smooth = np.interp(grid, t, w)
        return grid, self.stuck(smooth) if self.slips else smooth

    def stuck(self, smooth: Array) -> Array:
        """The same way in steps: at rest until it lags a step behind, then within 20 ms to where it should be."""
        step, slip = 2 * self.reach / self.slips, 0.02 * self.rate
        out, at, goal = np.empty_like(smooth), 0.0, 0.0
        for i, w in enumerate(smooth):
            if at == goal and (abs(w - at) >= step or abs(w) == self.reach):
                goal = w
            at = goal if abs(goal - at) <= step / slip else at + np.sign(goal - at) * step / slip
            out[i] = at
        return out

    def torque(self, t: Array, w: Array) -> Array:
        tau = self.spring(w) + self.drag * np.gradient(w, t)
        for stiffness, most in self.slip:
            tau = tau + stop(w, stiffness, most)
        step = np.diff(w, prepend=w[0])
        for T in CREEP_TIMES if self.creep else ():
            keep, z = float(np.exp(-1.0 / self.rate / T)), 0.0
            out = np.empty_like(w)
            for i, dw in enumerate(step):
                z = z * keep + dw
                out[i] = z
            tau = tau + self.creep * out
        return np.asarray(tau)

    def run(self, seed: int = 0, manifest: Mapping[str, Any] | None = None) -> MadeRun:
        """As two counting encoders and a noisy torque sensor see it."""
        rng = np.random.default_rng(seed)
        t, w = self.time_and_windup()
        tau = self.torque(t, w)
        theta_m = self.home + N * w
        if self.error is not None:
            for _ in range(30):  # θ_m/N − θ_l = w + θ̃_p(θ_m), θ_l = 0
                theta_m = self.home + N * (w + self.error_share * self.error.value(theta_m))
        columns = {
            "t": t,
            "theta_m": count(theta_m, 10_000, rng.uniform(0, 1e-3)),
            "theta_l": count(np.zeros_like(t) + 1e-6 * rng.standard_normal(t.size), 900_000, 3e-6),
            "tau_l": tau + self.zero + self.noise * rng.standard_normal(t.size),
        }
        about = {"procedure": "stiffness_lock", "gear": {"ratio": N}, "conditions": {"output_locked": True}}
        return MadeRun(columns, {**about, **(manifest or {})})


def stop(w: Array, stiffness: float, most: float) -> Array:
    """One Jenkins element: a spring that slips at ±`most`."""
    out, f = np.empty_like(w), 0.0
    for i, step in enumerate(np.diff(w, prepend=w[0])):
        f = min(max(f + stiffness * step, -most), most)
        out[i] = f
    return out


def three_lines(K1: float, K2: float, K3: float, T1: float, T2: float) -> Callable[[Array], Array]:
    """τ(u) of the makers' three lines, by interpolation of its corners."""
    u1 = T1 / K1
    u2 = u1 + (T2 - T1) / K2
    u3 = u2 + 10 * T2 / K3
    corners = np.array([-u3, -u2, -u1, 0.0, u1, u2, u3])
    heights = np.array([-11 * T2, -T2, -T1, 0.0, T1, T2, 11 * T2])
    return lambda u: np.interp(u, corners, heights)
