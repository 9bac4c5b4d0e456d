"""The three equations of the rig at the orders of the wave generator, each solved for what it alone can say.

Load     τ_l = J_l·ω̇_l + B_l·ω_l − (T − δ)·τ̇_l      T, δ: how late torque sensor and load encoder read, after the motor
Spring   θ̃ = θ̃_p + (τ_l + T·τ̇_l)/K + (B_sp/K)·φ̇ + δ·ω_l,  φ = θ̃_p − θ̃
Motor    τ_m − τ_l·(1/N − θ̃_p′) − B·ω_m = J_m·ω̇_m

T and B_sp act alike in the spring's equation (τ̇_l is nearly −K·φ̇): T comes from the load's.
[ghorbel2001, Eqs. 6-7]
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.identify.gram import Known, Rows, known, solve
from rig.analysis.identify.solve import Solved
from rig.analysis.identify.windows import Projected
from rig.analysis.result import Array

J_L, B_L, LAG = range(3)  # columns of the load's fit; LAG: T − δ
J_M, B_M = range(2)  # of the motor's
SLOPES = 0.1  # by how much drag in small swings may differ from the mean's: part of it may pass the sensor by


def spring_columns(terms: int) -> tuple[int, int, int, int]:
    """Places of 1/K, B_sp/K and δ behind the 2·terms Fourier coefficients, and how many columns there are."""
    return 2 * terms, 2 * terms + 1, 2 * terms + 2, 2 * terms + 3


def unloaded(windows: Sequence[Projected]) -> list[Projected]:
    """Those without a weight, where there are any: the gear may be another under load."""
    free = [w for w in windows if w.tau_ext == 0.0]
    return free or list(windows)


def load_fit(windows: Sequence[Projected], drag: tuple[float, float] | None) -> Solved | None:
    """J_l, B_l and T − δ; `drag` (value, 1 σ) of B_l from the means: what its slope is for small swings, nearly."""
    rows = [
        Rows(w.run, np.stack((w.load_acceleration, w.load_speed, -w.shaft_rate), axis=2), w.shaft, w.inflation)
        for w in unloaded(windows)
        if np.isfinite(w.shaft).all()
    ]
    if not rows:
        return None
    if drag is None:
        return solve(rows, [], 3)
    return solve(rows, [_held("means", B_L, 3, drag[0], max(drag[1], SLOPES * abs(drag[0])))], 3)


def spring_fit(
    windows: Sequence[Projected], fixed: Sequence[Known], terms: int, lag: float, series: Array
) -> Solved | None:
    """θ̃_p, 1/K, B_sp/K and δ; `fixed`: slow and lock runs; `lag` T, s; `series` (2·terms,) so far, rad."""
    at_K, _, _, size = spring_columns(terms)
    rows = []
    for w in unloaded(windows):
        if not np.isfinite(w.shaft).all():
            continue
        torque = w.shaft + lag * w.shaft_rate
        stretch = w.column_rates @ series - w.bending_rate  # φ̇
        X = np.concatenate((w.columns, np.stack((torque, stretch, w.load_speed), axis=2)), axis=2)
        assert X.shape[2] == size == at_K + 3
        rows.append(Rows(w.run, X, w.error, w.inflation))
    return solve(rows, fixed, size)


def motor_fit(windows: Sequence[Projected], ratio: float, lag: float, drag: tuple[float, float]) -> Solved | None:
    """J_m and B; `drag` (value, 1 σ) of B from the means."""
    rows = []
    for w in unloaded(windows):
        y = w.motor_torque - w.levered - lag * w.shaft_rate / ratio
        if np.isfinite(y).all():
            rows.append(Rows(w.run, np.stack((w.motor_acceleration, w.motor_speed), axis=2), y, w.inflation))
    return solve(rows, [_held("means", B_M, 2, *drag)], 2) if rows else None


def _held(run: str, place: int, size: int, value: float, u: float) -> Known:
    """One coefficient known from elsewhere."""
    X = np.zeros((1, size))
    X[0, place] = 1.0
    return known(run, X, np.array([value]), max(u, 1e-9 * abs(value), 1e-15) ** 2)
