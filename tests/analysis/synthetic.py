"""Runs made of formulas, for tests: a motion, a kinematic error, what disturbs it, and two encoders that count."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.model.fourier import FourierSeries

Array = npt.NDArray[np.float64]
TURN = 2.0 * np.pi
ARCSEC = 180.0 / np.pi * 3600.0

# C_n in arcsec and psi_n in deg: a profile like the twin's, order 2 largest
PROFILE = FourierSeries.from_polar(
    np.array([4.3, 39.6, 2.2, 9.4, 1.1, 4.0, 0.7, 2.2, 0.4, 1.3, 0.4, 0.8, 0.3, 0.5, 0.2]) / ARCSEC,
    np.deg2rad(np.array([35, -62, 110, 20, -140, 75, 10, -95, 150, 45, -20, 130, -75, 5, -160.0])),
)


@dataclass(frozen=True)
class MadeRun:
    """Columns and a manifest with the face of a `rig.runfile.Run`."""

    columns: Mapping[str, Array]
    manifest: Mapping[str, Any] = field(default_factory=dict)
    name: str = "made"
    misfits: tuple[str, ...] = ()

    def column(self, name: str) -> Array | None:
        return self.columns.get(name)

    def has(self, name: str) -> bool:
        return name in self.columns

    @property
    def ratio(self) -> float:
        return float(self.manifest.get("gear", {}).get("ratio", 50))

    @property
    def procedure(self) -> str:
        return str(self.manifest.get("procedure", "kinematic_error"))

    @property
    def conditions(self) -> Mapping[str, Any]:
        return dict(self.manifest.get("conditions", {}))

    @property
    def declared(self) -> Mapping[str, Any]:
        return dict(self.manifest.get("declared", {}))


def triangle(t: Array, amplitude: float, frequency: float) -> Array:
    """0 → +A → −A → … [unit of `amplitude`], zero to peak."""
    phase = (t * frequency) % 1.0
    return np.where(phase < 0.25, 4 * phase, np.where(phase < 0.75, 2 - 4 * phase, 4 * phase - 4)) * amplitude


def wander(rng: np.random.Generator, n: int, dt: float, tau: float, sigma: float) -> Array:
    """First-order noise of correlation time `tau` [s] and 1 σ `sigma`, stationary from the first row."""
    decay = float(np.exp(-dt / tau))
    kicks = rng.standard_normal(n) * sigma * np.sqrt(1 - decay**2)
    kicks[0] = rng.standard_normal() * sigma
    # the recursion x_i = d·x_{i−1} + k_i in blocks: a cumulative sum of k·d^-i, restarted before d^-i overflows
    out, size = np.empty(n), max(int(30.0 * tau / dt), 1)
    last = 0.0
    for lo in range(0, n, size):
        k = kicks[lo : lo + size]
        power = decay ** np.arange(1, k.size + 1)
        out[lo : lo + size] = power * (last + np.cumsum(k / power))
        last = out[min(lo + size, n) - 1]
    return out


def count(theta: Array, per_turn: int, offset: float = 0.0) -> Array:
    """What an incremental encoder of `per_turn` counts says of `theta` [rad]."""
    return np.floor((theta + offset) * per_turn / TURN) * (TURN / per_turn)


def slow_run(
    seed: int,
    *,
    profile: FourierSeries = PROFILE,
    rate: float = 1000.0,
    cycles: int = 2,
    amplitude_turns: float = 4.0,
    frequency: float = 0.01,
    offset: float = 28.8,
    wander_arcsec: float = 0.29,
    wander_s: float = 0.3,
    trend_arcsec: float = 0.0,
    ripple: float = 0.01,
    counts_m: int = 10_000,
    counts_l: int = 900_000,
    ratio: float = 50.0,
    manifest: Mapping[str, Any] | None = None,
) -> MadeRun:
    """A triangle under a position loop: ripple of the speed (locked to the angle and not), quantised encoders, friction
    wander, an offset by direction that builds up over a tenth of a turn, eccentricity of the output (`trend_arcsec`).
    """
    rng = np.random.default_rng(seed)
    dt = 1.0 / rate
    t = np.arange(int(cycles / frequency * rate)) * dt
    reference = triangle(t, amplitude_turns * TURN, frequency)
    omega = 4 * amplitude_turns * frequency * TURN
    sway = wander(rng, t.size, dt, 0.05, 1.0)
    theta_m = reference + ripple * omega * (0.02 * sway + 0.1 * np.sin(2 * reference + 1.0) + 0.02 * np.sin(40.0 * t))
    travelled = np.diff(reference, prepend=reference[0])
    side = np.empty_like(t)
    memory = 0.0  # the offset follows the direction over a tenth of a turn of travel
    sign, step = np.sign(travelled), np.abs(travelled) / (0.03 * TURN)
    flips = np.flatnonzero(np.diff(sign, prepend=sign[0]))
    for lo, hi in zip([0, *flips], [*flips, t.size], strict=True):
        s = sign[min(lo + 1, t.size - 1)]
        side[lo:hi] = s + (memory - s) * np.exp(-np.cumsum(step[lo:hi]))
        memory = side[hi - 1] if hi > lo else memory
    error = profile.value(theta_m) + offset / ARCSEC * side
    error += wander(rng, t.size, dt, wander_s, wander_arcsec / ARCSEC)
    error += trend_arcsec / ARCSEC * np.sin(theta_m / ratio + 0.7)
    theta_l = theta_m / ratio - error
    theta_l += rng.standard_normal(t.size) * 0.3 / ARCSEC
    columns = {
        "t": t,
        "theta_m": count(theta_m, counts_m, rng.uniform(0, TURN / counts_m)),
        "theta_l": count(theta_l, counts_l, rng.uniform(0, TURN / counts_l)),
        "theta_ref": reference,
    }
    encoders = {"motor_counts_per_rev": counts_m, "load_counts_per_rev": counts_l}
    base = {"procedure": "kinematic_error", "status": "completed", "gear": {"ratio": ratio}, "encoders": encoders}
    return MadeRun(columns, {**base, **(manifest or {})})
