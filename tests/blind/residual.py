"""What the baseline model leaves over, by a fit of this test's own: to size effects and to feed the peers.

Three channels: angle (theta_l), load torque (tau_l), motor torque (tau_m). Each run keeps its own zero. The model is the
paper's: 15 orders, constant stiffness, viscous damping, constant friction. `reversal` is a fourth channel for effects that
live where the motor turns back: the motor torque there, compared in time, for those runs follow a reference in time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import savgol_filter

from tests.blind.campaign import Taken
from tests.blind.rig import HARMONICS

WINDOW = 11  # rows of the local cubic that smooths and differentiates every column alike
AT_REST = 0.3  # rad/s at the motor: slower is reversal or sticking, left out of the torque channels
AROUND = 0.25  # s around a reversal
CHANNELS = ("theta_l", "tau_l", "tau_m")


@dataclass(frozen=True)
class Smooth:
    """One run, smoothed alike in every column: angles rad, torques N·m, derivatives by s, rows in order of time."""

    name: str
    run: Taken
    t: np.ndarray
    theta_m: np.ndarray
    w: np.ndarray
    dw: np.ndarray
    theta_l: np.ndarray
    wl: np.ndarray
    dwl: np.ndarray
    torque: np.ndarray
    dtorque: np.ndarray
    tau_m: np.ndarray
    moving: np.ndarray


def smooth(run: Taken) -> Smooth:
    c, dt = run.columns, run.plan.dt

    def local(x: np.ndarray, order: int = 0) -> np.ndarray:
        return np.asarray(savgol_filter(x, WINDOW, 3, deriv=order, delta=dt))[WINDOW:-WINDOW]

    w = local(c["theta_m"], 1)
    moving = np.abs(w) > AT_REST
    reach = round(AROUND / dt)
    turning = np.convolve(~moving, np.ones(2 * reach + 1), "same") > 0.5
    return Smooth(
        run.plan.name, run, c["t"][WINDOW:-WINDOW], local(c["theta_m"]), w, local(c["theta_m"], 2), local(c["theta_l"]),
        local(c["theta_l"], 1), local(c["theta_l"], 2), local(c["tau_l"]), local(c["tau_l"], 1), local(c["tau_m"]), ~turning,
    )  # fmt: skip


def series(angle: np.ndarray) -> np.ndarray:
    """The 2 x 15 columns of the paper's Eq. 8 without its constant."""
    order = np.arange(1, HARMONICS + 1)
    return np.hstack([np.cos(angle[:, None] * order), np.sin(angle[:, None] * order)])


def series_slope(angle: np.ndarray) -> np.ndarray:
    order = np.arange(1, HARMONICS + 1)
    return np.hstack([-order * np.sin(angle[:, None] * order), order * np.cos(angle[:, None] * order)])


def fit(columns: list[np.ndarray], values: list[np.ndarray]) -> tuple[np.ndarray, list[np.ndarray]]:
    """Least squares over runs with a zero of its own per run; returns coefficients and residuals per run."""
    centred = [(x - x.mean(axis=0), y - y.mean()) for x, y in zip(columns, values, strict=True)]
    scale = np.sqrt(sum(np.sum(x**2, axis=0) for x, _ in centred)) + 1e-30
    gram = sum((x / scale).T @ (x / scale) for x, _ in centred)
    right = sum((x / scale).T @ y for x, y in centred)
    beta = np.linalg.lstsq(gram, right, rcond=1e-10)[0] / scale
    return beta, [y - x @ beta for x, y in centred]


@dataclass(frozen=True)
class Baseline:
    """Coefficients of the fitted baseline by channel; `angle` = 30 of the series, then T and T'."""

    angle: np.ndarray
    load: np.ndarray
    motor: np.ndarray


Residuals = dict[str, dict[str, np.ndarray]]


def angle_columns(s: Smooth) -> np.ndarray:
    return np.hstack([-series(s.theta_m), -s.torque[:, None], s.dtorque[:, None]])


def load_columns(s: Smooth) -> np.ndarray:
    return np.column_stack([s.dwl, s.wl, np.sign(s.wl)])[s.moving]


def motor_columns(s: Smooth) -> np.ndarray:
    return np.column_stack([s.dw, s.w, np.sign(s.w)])[s.moving]


def motor_value(s: Smooth, p: np.ndarray, ratio: float) -> np.ndarray:
    """Motor torque less what passes the mesh: T (1/N - p')."""
    return (s.tau_m - s.torque * (1 / ratio - series_slope(s.theta_m) @ p))[s.moving]


def residuals(runs: list[Taken], ratio: float = 50.0) -> tuple[Residuals, Baseline]:
    """Residual per channel and run name; the torque channels hold the rows in which the motor turns."""
    done = [smooth(run) for run in runs if run.plan.procedure != "standstill"]
    beta_a, left_a = fit([angle_columns(s) for s in done], [s.theta_l - s.theta_m / ratio for s in done])
    free = [s for s in done if not s.run.plan.locked]
    beta_l, left_l = fit([load_columns(s) for s in free], [s.torque[s.moving] for s in free])
    p = beta_a[: 2 * HARMONICS]
    beta_m, left_m = fit([motor_columns(s) for s in free], [motor_value(s, p, ratio) for s in free])
    out: Residuals = {
        "theta_l": {s.name: e for s, e in zip(done, left_a, strict=True)},
        "tau_l": {s.name: e for s, e in zip(free, left_l, strict=True)},
        "tau_m": {s.name: e for s, e in zip(free, left_m, strict=True)},
    }
    return out, Baseline(beta_a, beta_l, beta_m)


def rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))
