"""Equations projected on the orders of the wave generator: smooth windows whose derivatives replace those of the data.

∫ψ·θ̈ dt = ∫ψ̈·θ dt for a test function ψ = w(t)·e^{−jωt} that vanishes with its derivatives at both ends: the data are
never differentiated, and no steady state is assumed      [preisig1993]
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.identify.recording import Plateau
from rig.analysis.orders.sums import harmonics
from rig.core.units import TURN
from rig.model.transmission_error import transmission_error

Complex = npt.NDArray[np.complex128]
TURNS = 7  # a window at least: sin⁴ passes six orders' width between its first zeros, so neighbours stay apart
LEAST = 0.8  # s at least
SHARE = 3  # windows begin a third of their length apart: nearly all that overlapping can give
FASTEST = 0.12  # of the row rate, Hz: above, sensors and straight rows distort
UNEVEN = 0.02  # of the row period: rows farther from an even grid are interpolated onto it
HERE = 4  # windows of a plateau at least


@dataclass(frozen=True)
class Projected:
    """One plateau's windows. All (W, n_orders), phasors as of θ_m = 0, SI; columns (W, n, 2·terms).

    Turned to one angle of the motor, what repeats with the angle is the same in every window; the rest is noise.
    """

    run: str
    begin: float  # s, of the plateau
    omega: float  # rad/s of the motor, mean
    tau_ext: float
    followed: bool  # a loop held the speed
    orders: Array  # (n,)
    inflation: float  # of the variance of a mean of W windows that overlap
    error: Complex  # θ̃
    columns: Complex  # cos nθ_m, then sin nθ_m
    bending_rate: Complex  # d/dt of θ̃ − θ̃_p is made from these two
    column_rates: Complex
    load_speed: Complex
    load_acceleration: Complex
    motor_speed: Complex
    motor_acceleration: Complex
    shaft: Complex  # τ_l
    shaft_rate: Complex
    shaft_acceleration: Complex
    levered: Complex  # τ_l·(1/N − θ̃_p′) with the slope given
    motor_torque: Complex  # τ_m
    motor_torque_rate: Complex

    @property
    def stretch(self) -> str:
        """Its name among all of a campaign."""
        return f"{self.run} from {self.begin:.3f} s"

    @property
    def windows(self) -> int:
        """How many."""
        return int(self.error.shape[0])


@lru_cache(maxsize=64)
def _window(size: int) -> tuple[Array, Array, Array]:
    """w = sin⁴(πx) and its derivatives by x over 0 < x < 1."""
    x = (np.arange(size) + 0.5) / size
    s, c = np.sin(np.pi * x), np.cos(np.pi * x)
    return s**4, 4 * np.pi * s**3 * c, 4 * np.pi**2 * s**2 * (3 * c**2 - s**2)


@lru_cache(maxsize=256)
def overlap_inflation(windows: int) -> float:
    """How much larger the variance of the mean of `windows` overlapping windows is than that of independent ones."""
    size = 600
    w = _window(size)[0]
    total = 1.0
    for k in range(1, min(SHARE, windows)):
        shift = k * size // SHARE
        total += 2.0 * (1.0 - k / windows) * float(w[shift:] @ w[: size - shift] / (w @ w))
    return total


def project(plateau: Plateau, terms: int, slope: Array) -> Projected | None:
    """The plateau's windows; `slope` is θ̃_p′ at every row of the run. None when it is too short for one."""
    run, part = plateau.run, slice(plateau.lo, plateau.hi)
    t, theta = run.t[part], run.theta_m[part]
    signals = [theta, run.theta_l[part]]
    nothing = np.full(theta.size, np.nan)
    tau_l = nothing if run.tau_l is None else run.tau_l[part]
    tau_m = nothing if run.tau_m is None else run.tau_m[part]
    signals += [tau_l, tau_m, tau_l * (1.0 / run.ratio - slope[part])]
    dt = float(t[-1] - t[0]) / (t.size - 1)
    if np.max(np.abs(t - t[0] - dt * np.arange(t.size))) > UNEVEN * dt:
        even = t[0] + dt * np.arange(t.size)
        signals = [np.interp(even, t, s) for s in signals]
    length = max(TURNS * TURN / abs(plateau.omega), LEAST)
    size = int(length / dt)
    step = size // SHARE
    starts = np.arange(0, t.size - size + 1, step) if step else np.empty(0, dtype=int)
    orders = np.arange(1.0, terms + 1)
    orders = orders[orders * abs(plateau.omega) / TURN < FASTEST / dt]
    if starts.size < HERE or orders.size == 0 or dt <= 0.0:
        return None
    tests = _tests(size, dt, orders * abs(plateau.omega))
    made = [_one(tests, [s[a : a + size] for s in signals], run.ratio, terms, orders) for a in starts]
    stacked = [np.stack(x) for x in zip(*made, strict=True)]
    return Projected(
        run.name, float(t[0]), plateau.omega, run.tau_ext, plateau.followed, orders,
        overlap_inflation(int(starts.size)), *stacked,
    )  # fmt: skip


def _tests(size: int, dt: float, omega: Array) -> tuple[Complex, Complex, Complex]:
    """ψ, −ψ̇ and ψ̈ (n, size), scaled so that a phasor A·e^{jωt} shows A."""
    w, w1, w2 = _window(size)
    T = size * dt
    t = (np.arange(size) - 0.5 * (size - 1)) * dt
    wave = np.exp(-1j * np.multiply.outer(omega, t)) * (2.0 / w.sum())
    j = 1j * omega[:, None]
    return wave * w, -wave * (w1 / T - j * w), wave * (w2 / T**2 - 2 * j * w1 / T - omega[:, None] ** 2 * w)


def _one(
    tests: tuple[Complex, Complex, Complex], signals: list[Array], ratio: float, terms: int, orders: Array
) -> tuple[Complex, ...]:
    """One window in the order of Projected's fields, from `error` on."""
    value, rate, acceleration = tests
    theta, theta_l, tau_l, tau_m, levered = signals
    waves = harmonics(theta, terms).T
    w = _window(theta.size)[0]
    turned = np.exp(-1j * orders * float(w @ theta / w.sum()))  # the angle in the middle, its ripple averaged out
    theta, theta_l, tau_l, tau_m, levered = (_less_line(s) for s in (theta, theta_l, tau_l, tau_m, levered))
    error = transmission_error(theta, theta_l, ratio)
    phasors = (
        value @ error, value @ waves, rate @ error, rate @ waves,
        rate @ theta_l, acceleration @ theta_l, rate @ theta, acceleration @ theta,
        value @ tau_l, rate @ tau_l, acceleration @ tau_l, value @ levered, value @ tau_m, rate @ tau_m,
    )  # fmt: skip
    return tuple(p * (turned if p.ndim == 1 else turned[:, None]) for p in phasors)


def _less_line(y: Array) -> Array:
    """`y` about its best straight line: what is left of offsets in a window of finite length vanishes."""
    x = np.linspace(-1.0, 1.0, y.size)
    return np.asarray(y - y.mean() - x * (x @ y) / (x @ x))
