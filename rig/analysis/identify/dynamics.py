"""The three equations of the rig at the orders of the wave generator, each solved for what it alone can say.

Load     τ_l = J_l·ω̇_l + B_l·ω_l − (T − δ)·τ̇_l − Q·τ̈_l
Spring   θ̃ = θ̃_p + (τ_l + T·τ̇_l + Q·τ̈_l + σ·B_ml·(ω_m + σ·ω_l))/K + (B_sp/K)·φ̇ + δ·ω_l,  φ = θ̃_p − θ̃
Motor    τ_m + S·τ̇_m − (τ_l + T·τ̇_l + Q·τ̈_l + σ·B_ml·(ω_m + σ·ω_l))·(1/N − θ̃_p′) − B·ω_m = J_m·ω̇_m
[ghorbel2001, Eqs. 6-7]

T, δ and S: how late torque sensor, load encoder and drive read, after the motor's encoder. Q: what the sensor does to
fast torques beyond delaying them. T and B_sp act alike in the spring's equation (τ̇_l is nearly −K·φ̇): T comes from
the load's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.gram import Complex, Known, Rows, known, solve
from rig.analysis.identify.solve import Solved
from rig.analysis.identify.windows import Projected

J_L, B_L, LAG, Q = range(4)  # columns of the load's fit; LAG: T − δ
J_M, B_M, LATE = range(3)  # of the motor's; LATE: S, a column only where a loop moves the torque
SLOPES = 0.1  # by how much drag in small swings may differ from the mean's: part of it may pass the sensor by


def spring_columns(terms: int) -> tuple[int, int, int, int]:
    """Places of 1/K, B_sp/K and δ behind the 2·terms Fourier coefficients, and how many columns there are."""
    return 2 * terms, 2 * terms + 1, 2 * terms + 2, 2 * terms + 3


def unloaded(windows: Sequence[Projected]) -> list[Projected]:
    """Those without a weight, where there are any: the gear may be another under load."""
    free = [w for w in windows if w.tau_ext == 0.0]
    return free or list(windows)


@dataclass(frozen=True)
class Mesh:
    """B_ml as far as anybody knows it: it drags in parallel to the spring      [ghorbel2001, Eq. 5]"""

    B_ml: float = 0.0  # N·m·s/rad
    half_range: float = (
        0.0  # either way of it: declared numbers are good to a third, undeclared ones to all of the drag
    )
    sigma: int = 1

    def drag(self, w: Projected) -> Complex:
        """σ·B_ml·(ω_m + σ·ω_l), N·m on the load."""
        return self.sigma * self.B_ml * (w.motor_speed + self.sigma * w.load_speed)

    def levered(self, w: Projected, ratio: float, series: Array) -> Complex:
        """The mean of the same times θ̃_p′, N·m on the motor; `series` (a_n, b_n) rad."""
        mean = self.sigma * self.B_ml * w.omega * (1.0 + self.sigma / ratio)
        a, b = np.split(series, 2)
        n = np.arange(1.0, a.size + 1)
        return np.asarray(mean * (w.columns @ np.concatenate((n * b, -n * a))))


@dataclass(frozen=True)
class Sensor:
    """How the torque sensor's reading becomes the torque: r + lag·ṙ + curve·r̈."""

    lag: float = 0.0  # s, T
    curve: float = 0.0  # s², Q

    def true(self, w: Projected) -> Complex:
        """The shaft torque of a plateau's windows, N·m."""
        return w.shaft + self.lag * w.shaft_rate + self.curve * w.shaft_acceleration


def load_fit(windows: Sequence[Projected], drag: tuple[float, float] | None) -> Solved | None:
    """J_l, B_l and T − δ; `drag` (value, 1 σ) of B_l from the means: what its slope is for small swings, nearly."""
    rows = [
        Rows(
            w.stretch,
            np.stack((w.load_acceleration, w.load_speed, -w.shaft_rate, -w.shaft_acceleration), axis=2),
            w.shaft,
            w.inflation,
        )
        for w in unloaded(windows)
        if np.isfinite(w.shaft).all()
    ]
    if not rows:
        return None
    if drag is None:
        return solve(rows, [], 4)
    return solve(rows, [_held("means", B_L, 4, drag[0], max(drag[1], SLOPES * abs(drag[0])))], 4)


def spring_fit(
    windows: Sequence[Projected], fixed: Sequence[Known], terms: int, sensor: Sensor, mesh: Mesh, series: Array
) -> Solved | None:
    """θ̃_p, 1/K, B_sp/K and δ; `fixed`: slow and lock runs; `series` (2·terms,) so far, rad."""
    at_K, _, _, size = spring_columns(terms)
    rows = []
    for w in unloaded(windows):
        if not np.isfinite(w.shaft).all():
            continue
        torque = sensor.true(w) + mesh.drag(w)
        stretch = w.column_rates @ series - w.bending_rate  # φ̇
        X = np.concatenate((w.columns, np.stack((torque, stretch, w.load_speed), axis=2)), axis=2)
        assert X.shape[2] == size == at_K + 3
        rows.append(Rows(w.stretch, X, w.error, w.inflation))
    return solve(rows, fixed, size)


def motor_fit(
    windows: Sequence[Projected], ratio: float, sensor: Sensor, mesh: Mesh, series: Array, drag: tuple[float, float]
) -> Solved | None:
    """J_m and B; `drag` (value, 1 σ) of B from the means. Stretches without a loop count alone where there are any:
    a loop answers to what friction does, and steps its torque between the rows.
    """
    free = [w for w in unloaded(windows) if not w.followed]
    rows = []
    for w in free or unloaded(windows):
        y = w.motor_torque - w.levered - (sensor.true(w) - w.shaft) / ratio + mesh.levered(w, ratio, series)
        columns = (w.motor_acceleration, w.motor_speed) + (() if free else (-w.motor_torque_rate,))
        if np.isfinite(y).all():
            rows.append(Rows(w.stretch, np.stack(columns, axis=2), y, w.inflation))
    size = 2 if free else 3
    return solve(rows, [_held("means", B_M, size, *drag)], size) if rows else None


def _held(run: str, place: int, size: int, value: float, u: float) -> Known:
    """One coefficient known from elsewhere."""
    X = np.zeros((1, size))
    X[0, place] = 1.0
    return known(run, X, np.array([value]), max(u, 1e-9 * abs(value), 1e-15) ** 2)
