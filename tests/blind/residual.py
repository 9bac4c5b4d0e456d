"""What the baseline model leaves over, by a fit of this test's own: to size effects and to feed the peers.

Three channels: angle (theta_l), load torque (tau_l), motor torque (tau_m). The torque sensor's zero is free in every
run, the others are one for the campaign. The model is the paper's: 15 orders, constant stiffness, viscous damping,
constant friction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from tests.blind.rig import HARMONICS
from tests.blind.sensors import Columns
from tests.blind.taken import Taken

LIGHT = 5  # rows of the window that smooths every column of the angle channel alike
HEAVY = 21  # rows of the window for the torque channels, whose accelerations come from counts
AT_REST = 0.3  # rad/s at the motor: slower is reversal or sticking, left out of the torque channels
AROUND = 0.25  # s around a reversal
EDGE = HEAVY  # rows left out at both ends
STRIDE = 3  # every third row is kept: neighbours are correlated by the windows
CHANNELS = ("theta_l", "tau_l", "tau_m")


@dataclass(frozen=True)
class Smooth:
    """One run; angles rad, torques N·m, derivatives by s. `light_…` are for the angle channel, the rest for torques."""

    name: str
    run: Taken
    light_theta_m: np.ndarray
    light_theta_l: np.ndarray
    light_torque: np.ndarray
    light_dtorque: np.ndarray
    theta_m: np.ndarray
    w: np.ndarray
    dw: np.ndarray
    wl: np.ndarray
    dwl: np.ndarray
    torque: np.ndarray
    tau_m: np.ndarray
    moving: np.ndarray


def hann(rows: int) -> np.ndarray:
    window = np.hanning(rows + 2)[1:-1]
    return window / window.sum()


def slope(x: np.ndarray, dt: float, order: int) -> np.ndarray:
    """Derivative of a smoothed column: smoothing and differences commute, so every column passes the same filter."""
    for _ in range(order):
        x = np.gradient(x, dt)
    return x


def on_even_clock(c: Columns, dt: float) -> Columns:
    """The columns where the rows would lie on an even clock, by their own stamps."""
    even = np.arange(len(c["t"])) * dt
    if np.max(np.abs(c["t"] - even)) < 1e-6:
        return c
    return {name: np.asarray(CubicSpline(c["t"], x)(even)) for name, x in c.items()}


def smooth(run: Taken) -> Smooth:
    c, dt = on_even_clock(run.columns, run.plan.dt), run.plan.dt

    def light(name: str, order: int = 0) -> np.ndarray:
        return slope(np.convolve(c[name], hann(LIGHT), "same"), dt, order)[EDGE:-EDGE:STRIDE]

    def heavy(name: str, order: int = 0) -> np.ndarray:
        return slope(np.convolve(c[name], hann(HEAVY), "same"), dt, order)[EDGE:-EDGE:STRIDE]

    w = heavy("theta_m", 1)
    turning = np.convolve(np.abs(w) < AT_REST, np.ones(2 * round(AROUND / dt / STRIDE) + 1), "same") > 0.5
    return Smooth(
        run.plan.name, run, light("theta_m"), light("theta_l"), light("tau_l"), light("tau_l", 1),
        heavy("theta_m"), w, heavy("theta_m", 2), heavy("theta_l", 1), heavy("theta_l", 2),
        heavy("tau_l"), heavy("tau_m"), ~turning,
    )  # fmt: skip


def series(angle: np.ndarray) -> np.ndarray:
    """The 2 x 15 columns of the paper's Eq. 8 without its constant."""
    order = np.arange(1, HARMONICS + 1)
    return np.hstack([np.cos(angle[:, None] * order), np.sin(angle[:, None] * order)])


def series_slope(angle: np.ndarray) -> np.ndarray:
    order = np.arange(1, HARMONICS + 1)
    return np.hstack([-order * np.sin(angle[:, None] * order), order * np.cos(angle[:, None] * order)])


def fit(columns: list[np.ndarray], values: list[np.ndarray]) -> np.ndarray:
    """Coefficients of least squares over all runs."""
    gram = sum(x.T @ x for x in columns)
    right = sum(x.T @ y for x, y in zip(columns, values, strict=True))
    scale = np.sqrt(np.diag(gram)) + 1e-30
    return np.linalg.lstsq(gram / np.outer(scale, scale), right / scale, rcond=1e-12)[0] / scale


def centred(x: np.ndarray) -> np.ndarray:
    """A run with a zero of its own."""
    return x - x.mean(axis=0) if len(x) else x


@dataclass(frozen=True)
class Baseline:
    """Coefficients of the fitted baseline by channel; `angle` = 30 of the series, then T and T'."""

    angle: np.ndarray
    load: np.ndarray
    motor: np.ndarray


Residuals = dict[str, dict[str, np.ndarray]]


def angle_columns(s: Smooth) -> np.ndarray:
    return np.column_stack([-series(s.light_theta_m), -s.light_torque, s.light_dtorque, np.ones(len(s.w))])


def angle_value(s: Smooth, ratio: float) -> np.ndarray:
    return s.light_theta_l - s.light_theta_m / ratio


def load_columns(s: Smooth) -> np.ndarray:
    return centred(np.column_stack([s.dwl, s.wl, np.sign(s.w)])[s.moving])


def motor_columns(s: Smooth) -> np.ndarray:
    return np.column_stack([s.dw, s.w, np.sign(s.w), np.ones(len(s.w))])[s.moving]


def motor_value(s: Smooth, p: np.ndarray, ratio: float) -> np.ndarray:
    """Motor torque less what passes the mesh: T (1/N - p')."""
    return (s.tau_m - s.torque * (1 / ratio - series_slope(s.theta_m) @ p))[s.moving]


def usable(runs: list[Taken]) -> list[Smooth]:
    return [smooth(run) for run in runs if run.plan.procedure != "standstill"]


def turning_runs(done: list[Smooth]) -> list[Smooth]:
    """Runs with a free output in which the motor turned for a second at least: the torque channels."""
    return [s for s in done if not s.run.plan.locked and np.sum(s.moving) * s.run.plan.dt * STRIDE > 1.0]


def angle_left(s: Smooth, beta: np.ndarray, ratio: float) -> np.ndarray:
    return angle_value(s, ratio) - angle_columns(s) @ beta


def load_left(s: Smooth, beta: np.ndarray) -> np.ndarray:
    return centred(s.torque[s.moving]) - load_columns(s) @ beta


def motor_left(s: Smooth, baseline: Baseline, ratio: float) -> np.ndarray:
    return motor_value(s, baseline.angle[: 2 * HARMONICS], ratio) - motor_columns(s) @ baseline.motor


def fit_baseline(done: list[Smooth], ratio: float = 50.0) -> Baseline:
    """The paper's model fitted to these runs, channel by channel."""
    angle = fit([angle_columns(s) for s in done], [angle_value(s, ratio) for s in done])
    free = turning_runs(done)
    load = fit([load_columns(s) for s in free], [centred(s.torque[s.moving]) for s in free])
    p = angle[: 2 * HARMONICS]
    motor = fit([motor_columns(s) for s in free], [motor_value(s, p, ratio) for s in free])
    return Baseline(angle, load, motor)


def left_over(done: list[Smooth], baseline: Baseline, ratio: float = 50.0) -> Residuals:
    """Residual per channel and run name; the torque channels hold the rows in which the motor turns."""
    free = turning_runs(done)
    return {
        "theta_l": {s.name: angle_left(s, baseline.angle, ratio) for s in done},
        "tau_l": {s.name: load_left(s, baseline.load) for s in free},
        "tau_m": {s.name: motor_left(s, baseline, ratio) for s in free},
    }


def residuals(runs: list[Taken]) -> tuple[Residuals, Baseline]:
    """Baseline fitted to all runs, and what it leaves of them."""
    done = usable(runs)
    baseline = fit_baseline(done)
    return left_over(done, baseline), baseline


def angle_with_own_zeros(runs: list[Taken], ratio: float = 50.0) -> dict[str, np.ndarray]:
    """The angle's residual by run name when every run has an encoder zero of its own, as after homing."""
    done = usable(runs)
    columns = [centred(angle_columns(s)) for s in done]
    values = [centred(angle_value(s, ratio)) for s in done]
    beta = fit(columns, values)
    return {s.name: y - x @ beta for s, x, y in zip(done, columns, values, strict=True)}


def rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))
