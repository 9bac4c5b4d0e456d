"""How far the load was from its reference, without and with the kinematic error fed forward; and what was expected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.intervals import Ranged, t95
from rig.analysis.findings.result import Array
from rig.analysis.orders.align import Alignment, align
from rig.core.errors import DataError
from rig.core.quantiles import Z95
from rig.core.units import ARCSEC, RPM, TURN
from rig.model.fourier import FourierSeries
from rig.model.gearfile import GearFile
from rig.runfile.run import Run

BINS: Final = 180  # of a motor turn: 2°, twelve to a period of order 15
TRUSTED: Final = 8  # orders that vote for the encoder's zero: higher ones are nearly noise
DRAWS: Final = 200  # of the series and of the gear
LEAST: Final = 0.01  # of a parameter: none is zero or below, however wide its interval

Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Followed:
    """How a run's load followed. `error` is θ_l − θ_l,ref over the motor turn, forth and back, (2, BINS) rad, means
    taken off; `tracking` the same of the motor's own error over N, `loop` that turn by turn, (turns, BINS)."""

    peak_to_peak: Ranged
    rms: Ranged
    error: Array
    tracking: Array
    loop: Array
    turns: int


@dataclass(frozen=True)
class Expected:
    """What the model says, arcsec, and between what 95 % of the gears lie that the gear file allows."""

    peak_to_peak: float
    rms: float
    peak_to_peak_ci95: tuple[float, float]
    rms_ci95: tuple[float, float]


def followed(run: Run) -> Followed:
    """Measure one run of `compensated`. Raises DataError when it has no whole turns at speed."""
    conditions, ratio = run.conditions, run.ratio
    series = FourierSeries(tuple(conditions.get("feedforward_a") or ()), tuple(conditions.get("feedforward_b") or ()))
    theta_m, theta_l, ref = run.need("theta_m"), run.need("theta_l"), run.need("theta_ref")
    ideal = ref - (ratio * series.value(ref) if series.a else 0.0)
    e, lag = theta_l - ideal / ratio, (theta_m - ref) / ratio
    made = [
        _way(theta_m, e, lag, part)
        for part in _ways(ideal, int(conditions["revolutions"]), int(conditions["lead_turns"]))
    ]
    turns = np.concatenate([m[0] for m in made])
    return Followed(
        _figure(np.ptp(turns, axis=1) / ARCSEC),
        _figure(np.sqrt(np.mean(turns**2, axis=1)) / ARCSEC),
        np.array([m[0].mean(0) for m in made]),
        np.array([m[1].mean(0) for m in made]),
        np.concatenate([m[1] for m in made]),
        turns.shape[0],
    )


def _ways(ideal: Array, revolutions: int, lead: int) -> list[slice]:
    """Rows of the measured turns, forth and back: all but the first and the last `lead` turns of each way."""
    top = int(np.nanargmax(ideal))
    found = []
    for lo, hi in ((0, top), (top, ideal.size)):
        gone = np.abs(ideal[lo:hi] - ideal[lo if lo == 0 else top])
        at = lo + np.flatnonzero((gone >= TURN * lead) & (gone < TURN * (revolutions + lead)))
        if at.size < BINS * revolutions // 2:
            raise DataError(f"only {at.size} rows at speed: expected {revolutions} turns each way")
        found.append(slice(int(at[0]), int(at[-1]) + 1))
    return found


def _way(theta_m: Array, e: Array, lag: Array, part: slice) -> tuple[Array, Array]:
    """Error and tracking of each whole turn (turns, BINS), each turn's mean taken off."""
    theta = theta_m[part]
    turn = np.floor(np.abs(theta - theta[0]) / TURN).astype(np.int64)
    place = (np.mod(theta, TURN) / TURN * BINS).astype(np.int64) % BINS
    turns = int(turn.max())
    keep = turn < turns
    index = turn[keep] * BINS + place[keep]
    count = np.bincount(index, minlength=turns * BINS)
    out = []
    for y in (e, lag):
        total = np.bincount(index, y[part][keep], minlength=turns * BINS)
        with np.errstate(invalid="ignore"):
            binned = np.where(count > 0, total / np.maximum(count, 1), np.nan).reshape(turns, BINS)
        out.append(np.array([_whole(row) for row in binned]))
    return out[0], out[1]


def _whole(row: Array) -> Array:
    """Empty bins from their neighbours, the mean taken off."""
    good = np.isfinite(row)
    at = np.arange(row.size)
    filled = np.interp(at, at[good], row[good], period=row.size)
    return np.asarray(filled - filled.mean())


def _figure(values: Array) -> Ranged:
    """Mean over turns, interval from their scatter."""
    mean, n = float(values.mean()), values.size
    half = t95(n - 1) * float(values.std(ddof=1)) / np.sqrt(n) if n > 1 else float("nan")
    return Ranged(mean, mean - half, mean + half)


def zero_of(before: Followed, series: FourierSeries) -> Alignment | None:
    """By how far the motor encoder's zero has moved since the series was identified, from the run without it.

    The load's error is −θ̃ beside what the motor's own loop left. None when no order stands out.
    """
    k = len(series.a)
    orders = np.arange(1, k + 1)
    grid = (np.arange(BINS) + 0.5) / BINS * TURN
    waves = np.exp(-1j * np.multiply.outer(orders, grid))
    seen = np.array([2 / BINS * waves @ (t - e) for e, t in zip(before.error, before.tracking, strict=True)])
    u = np.maximum(np.abs(seen[0] - seen[1]) / 2, 1e-3 * ARCSEC)
    expected = np.array(series.a) - 1j * np.array(series.b)
    return align(seen.mean(0), expected, u, min(TRUSTED, k))


def turned(series: FourierSeries, shift: float) -> FourierSeries:
    """The series for an encoder whose zero has moved: c_n·exp(−jn·shift)."""
    n = np.arange(1, len(series.a) + 1)
    c = (np.array(series.a) - 1j * np.array(series.b)) * np.exp(-1j * n * shift)
    return FourierSeries(tuple(map(float, c.real)), tuple(map(float, -c.imag)))


def transmissibility(gear: GearFile, omega_m: float, orders: int, off: Array | None = None) -> Complex:
    """What the load makes of a motion of the gear's input side at orders 1..k of the motor's speed [rad/s]: (k,).

    G = (B_sp·s + K)/(J_l·s² + (B_sp + B_l)·s + K), the motor's angle imposed      [ghorbel2001, Eq. 7]
    `off` (4,) is by how many standard deviations K, B_sp, B_l and J_l are off; one nobody measured is off by nothing.
    """
    known = [gear.parameters[name] for name in ("K", "B_sp", "B_l", "J_l")]
    by = np.nan_to_num([p.half / Z95 for p in known]) * (0.0 if off is None else off)
    K, B_sp, B_l, J_l = (max(p.value + d, LEAST * p.value) for p, d in zip(known, by, strict=True))
    s = 1j * np.arange(1, orders + 1) * omega_m
    return np.asarray((B_sp * s + K) / (J_l * s**2 + (B_sp + B_l) * s + K))


def expected(gear: GearFile, speed_rpm: float, before: Followed, rng: np.random.Generator) -> tuple[Expected, Expected]:
    """Without and with compensation, both in single turns, as they are measured, and both with what the motor's loop
    had left without it: −θ̃_p through the model, and what is not known of θ̃_p. Intervals are those of gears that the
    gear file allows, and of single turns.
    """
    series, omega_m = gear.kinematic_error.series, speed_rpm * RPM
    k = len(series.a)
    c = np.array(series.a) - 1j * np.array(series.b)
    unknown = np.resize(_draws(gear, rng), (DRAWS, k))
    gears = rng.standard_normal((DRAWS, 4))
    n = np.arange(1, BINS // 4)
    waves = 2 / BINS * np.exp(-1j * np.multiply.outer(n, _grid()))
    loop = before.loop @ waves.T  # (turns, orders)
    model = transmissibility(gear, omega_m, n.size)
    may_be = [transmissibility(gear, omega_m, n.size, off) for off in gears]

    def told(error: Complex) -> Expected:
        """Of a load that leaves its reference by `error` (draws, k) beside what the loop leaves."""
        moved = loop[np.arange(DRAWS) % loop.shape[0]]
        moved[:, :k] += error
        high, rms = _figures([_wave(x * model) for x in moved])
        highs, many = _figures([_wave(x * G) for x, G in zip(moved, may_be, strict=True)])
        return Expected(float(np.mean(high)), float(np.sqrt(np.mean(rms**2))), _most(highs), _most(many))

    return told(-(c + unknown)), told(unknown)


def _figures(waves: list[Array]) -> tuple[Array, Array]:
    """Peak to peak and RMS of each, arcsec."""
    return np.ptp(waves, axis=1) / ARCSEC, np.sqrt(np.mean(np.square(waves), axis=1)) / ARCSEC


def _most(values: Array) -> tuple[float, float]:
    low, high = np.percentile(values, (2.5, 97.5))
    return float(low), float(high)


def _draws(gear: GearFile, rng: np.random.Generator) -> Complex:
    """Errors of the coefficients as their covariance has them, (DRAWS, k); zero where none was measured."""
    k = len(gear.kinematic_error.series.a)
    covariance = gear.kinematic_error.covariance
    if not np.isfinite(covariance).all():
        return np.zeros((1, k), dtype=np.complex128)
    drawn = rng.multivariate_normal(np.zeros(2 * k), covariance, DRAWS, check_valid="ignore", method="eigh")
    return np.asarray(drawn[:, :k] - 1j * drawn[:, k:])


def _grid() -> Array:
    return np.asarray((np.arange(BINS) + 0.5) / BINS * TURN)


def _wave(c: Complex) -> Array:
    """Re Σ c_n·exp(jnθ) on the grid, (BINS,)."""
    n = np.arange(1, c.size + 1)
    return np.asarray(np.real(np.exp(1j * np.multiply.outer(_grid(), n)) @ c))
