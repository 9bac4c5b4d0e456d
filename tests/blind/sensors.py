"""From the true motion to what the loggers write: counts, noise, zeros that jump, a clock that jitters, effects."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

MOTOR_COUNTS = 65536
LOAD_COUNTS = 1296000
TAU_L_STEP = 0.01  # N·m, resolution of the torque amplifier
TAU_M_STEP = 0.002  # N·m, resolution of the drive's report

Columns = dict[str, np.ndarray]
Change = Callable[[Columns, "Context"], None]


@dataclass(frozen=True)
class Noise:
    """What does not repeat, drawn once per case; standard deviations in the channel's unit."""

    friction_m: float
    friction_l: float
    wander: float
    tau_l: float
    tau_m: float
    encoder_l: float
    zero: float
    zero_jump: float
    zero_drift: float
    gain: float
    jitter: float


def draw_noise(rng: np.random.Generator) -> Noise:
    """Noise of one rig: the level of the reference campaigns ±30 %; one rig in three has a clock that jitters."""
    u = rng.uniform(0.7, 1.3, 10)
    jitter = float(rng.choice([0.0, 0.0, 2e-5]))
    return Noise(
        friction_m=1.5e-3 * u[0], friction_l=0.035 * u[1], wander=2.4e-6 * u[2], tau_l=0.048 * u[3],
        tau_m=1.7e-3 * u[4], encoder_l=1.5e-6 * u[5], zero=0.05 * float(rng.standard_normal()),
        zero_jump=0.004 * u[7], zero_drift=0.002 * u[8], gain=1.5e-4 * u[9], jitter=jitter,
    )  # fmt: skip


def coloured(rng: np.random.Generator, n: int, dt: float, corner_hz: float) -> np.ndarray:
    """Unit-variance noise with a first-order corner (an Ornstein-Uhlenbeck process)."""
    a = float(np.exp(-2 * np.pi * corner_hz * dt))
    start = rng.standard_normal()
    return lfilter([np.sqrt(1 - a * a)], [1.0, -a], rng.standard_normal(n), zi=[a * start])[0]


@dataclass(frozen=True)
class Context:
    """The run whose columns are changed: campaign time at its t = 0, and a generator for effects with chance."""

    name: str
    start_s: float
    rng: np.random.Generator


@dataclass
class Sensors:
    """Effects that live in what is read, not in what moves. Delays in s, a positive one reads late."""

    late: dict[str, float] = field(default_factory=dict)
    lag: dict[str, float] = field(default_factory=dict)
    changes: list[Change] = field(default_factory=list)
    motor_steps: Callable[[str, int, np.random.Generator], np.ndarray] | None = None
    temperature: bool = False


def delayed(t: np.ndarray, x: np.ndarray, at: np.ndarray) -> np.ndarray:
    return np.asarray(CubicSpline(t, x)(np.clip(at, t[0], t[-1])))


def lagged(x: np.ndarray, dt: float, tau: float) -> np.ndarray:
    """First-order lag, exact for an input that is straight between ticks (first-order hold)."""
    a = float(np.exp(-dt / tau))
    now = 1 - (1 - a) * tau / dt
    start = x[0] - tau * (x[1] - x[0]) / dt  # in steady motion from before the record on
    y, _ = lfilter([now, 1 - a - now], [1.0, -a], x[1:], zi=[a * start + (1 - a - now) * x[0]])
    return np.concatenate([[start], y])


def stamps(rng: np.random.Generator, n: int, dt: float, noise: Noise) -> np.ndarray:
    """True times of the rows: an even clock, or one whose instants jitter and are stamped as they were."""
    t = np.arange(n) * dt
    if noise.jitter > 0:
        t = t + np.abs(rng.normal(0, noise.jitter, n))
        t = t - t[0]
    return t


def measure(
    raw: Columns, plan_dt: float, sensors: Sensors, noise: Noise, where: Context, rng: np.random.Generator
) -> Columns:
    """Rows of one run from the 1 kHz record `raw` (t from 0; theta_m, theta_l, tau_l, tau_m in SI)."""
    grid = raw["t"]
    n = round((grid[-1] - grid[0]) / plan_dt)
    every = round(plan_dt / 1e-3)
    t = stamps(rng, n, plan_dt, noise)
    out: Columns = {"t": t}
    for name in ("theta_m", "theta_l", "tau_l", "tau_m"):
        x = raw[name]
        if name in sensors.lag:
            x = lagged(x, float(grid[1] - grid[0]), sensors.lag[name])
        shift = sensors.late.get(name, 0.0)
        if shift == 0.0 and noise.jitter == 0.0:
            out[name] = x[: n * every : every].copy()
        elif name == "tau_m":  # a command is held between ticks
            index = np.clip(np.floor((t - shift) / 1e-3 + 1e-9).astype(int), 0, len(x) - 1)
            out[name] = x[index]
        else:
            out[name] = delayed(grid, x, t - shift)
    for change in sensors.changes:
        change(out, where)
    add_noise(out, plan_dt, noise, rng)
    quantise(out)
    return out


def add_noise(out: Columns, dt: float, noise: Noise, rng: np.random.Generator) -> None:
    """Noise of the channels; zero and gain of the torque sensor are drawn anew for every run."""
    n = len(out["t"])
    out["theta_l"] += noise.wander * coloured(rng, n, dt, 2.0) + rng.normal(0, noise.encoder_l, n)
    drift = noise.zero_drift * rng.standard_normal() * np.linspace(0, 1, n)
    zero = noise.zero + noise.zero_jump * rng.standard_normal() + drift
    gain = 1 + noise.gain * rng.standard_normal()
    hiss = 0.9 * rng.standard_normal(n) + 0.43 * coloured(rng, n, dt, 25.0)
    out["tau_l"] = gain * out["tau_l"] + zero + noise.tau_l * hiss
    out["tau_m"] = out["tau_m"] + noise.tau_m * rng.standard_normal(n)


def quantise(out: Columns) -> None:
    for name, counts in (("theta_m", MOTOR_COUNTS), ("theta_l", LOAD_COUNTS)):
        q = 2 * np.pi / counts
        out[name] = np.round(out[name] / q) * q
    out["tau_l"] = np.round(out["tau_l"], 2)
    out["tau_m"] = np.round(np.round(out["tau_m"] / TAU_M_STEP) * TAU_M_STEP, 3)
