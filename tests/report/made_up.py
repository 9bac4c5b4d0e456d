"""A run that never was: the gear of the twin's bench, 28 revolutions each way, with noise. For tests of the page."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Check, Estimate, Result, Verdict
from rig.model.fourier import FourierSeries

C_DEG = [
    0.0012,
    0.011,
    0.0006,
    0.0026,
    0.0003,
    0.0011,
    0.0002,
    0.0006,
    0.00012,
    0.00035,
    1e-4,
    0.00022,
    8e-5,
    0.00014,
    6e-5,
]
PSI_DEG = [35, -62, 110, 20, -140, 75, 10, -95, 150, 45, -20, 130, -75, 5, -160]
SERIES = FourierSeries.from_polar(np.array(C_DEG) * 3600, np.radians(PSI_DEG))  # arcsec

Array = npt.NDArray[np.float64]


def curves(seed: int = 1, revolutions: int = 28, grid: int = 512) -> dict[str, Array]:
    """Every curve the report knows, in the units of `Result.curves`."""
    rng = np.random.default_rng(seed)
    theta = np.linspace(0, 360, grid, endpoint=False)
    true = SERIES.value(np.radians(theta))
    offset = 1.1 * np.cos(np.radians(2 * theta) + 0.4)

    def turns(sign: float) -> Array:
        wander = rng.normal(0, 0.5, (revolutions, 1)) + np.cumsum(rng.normal(0, 0.12, (revolutions, grid)), axis=1)
        return np.asarray(true + sign * offset + wander + rng.normal(0, 0.9, (revolutions, grid)))

    forward, reverse = turns(1.0), turns(-1.0)
    mean_f, mean_r = forward.mean(0), reverse.mean(0)
    pure = (mean_f + mean_r) / 2
    pure -= pure.mean()
    spectrum = 2 * np.fft.rfft(pure) / grid
    n = np.arange(1, 16)
    angle = np.multiply.outer(np.radians(theta), n)
    a, b = spectrum.real[1:16], -spectrum.imag[1:16]
    fit = np.cos(angle) @ a + np.sin(angle) @ b
    k = np.arange(1, 26)
    mse = np.array([np.sum(np.abs(spectrum[j + 1 : -1]) ** 2) / 2 for j in k])
    fine = np.arange(0, 20.001, 1 / revolutions)
    lines = 0.08 * rng.rayleigh(1, fine.size) / (1 + fine)
    for order, c in zip(n, np.hypot(a, b), strict=True):
        lines += c * np.exp(-(((fine - order) / 0.03) ** 2))
    t = np.linspace(0, 200, 1500)
    reference = 1440 * (2 / np.pi) * np.arcsin(np.sin(2 * np.pi * 0.01 * t))
    way = np.sign(np.cos(2 * np.pi * 0.01 * t))
    error = 0.12 * way + rng.normal(0, 0.01, t.size)
    speed = 9.6 * way + 0.07 * np.cos(2 * np.radians(reference))
    tau_m = 0.303 * way + 0.02 * np.cos(2 * np.radians(reference)) + rng.normal(0, 0.004, t.size)
    tau_l = 1.0 * way + rng.normal(0, 0.03, t.size)
    cycle = np.concatenate([np.linspace(0, 15, 300), np.linspace(15, -15, 600), np.linspace(-15, 15, 600)])
    up = np.concatenate([np.ones(300), -np.ones(600), np.ones(600)])
    torsion = (cycle / 7160 - 0.00004 * up * (1 - (cycle / 17) ** 2)) * 180 * 60 / np.pi
    return _loads() | {
        "ke.theta_deg": theta,
        "ke.revolutions_forward": forward,
        "ke.revolutions_reverse": reverse,
        "ke.mean_forward": mean_f,
        "ke.mean_reverse": mean_r,
        "ke.pure": pure,
        "ke.direction": (mean_f - mean_r) / 2,
        "ke.fit": fit,
        "orders.order": n.astype(float),
        "orders.amplitude": np.hypot(a, b),
        "orders.ci95": 0.05 + 0.25 / n,
        "spectrum.order": fine,
        "spectrum.amplitude": lines,
        "mse.k": k.astype(float),
        "mse.value": mse,
        "mse.floor": np.array([mse[15] * 1.1]),
        "mse.chosen": np.array([15.0]),
        "time.t": t,
        "time.theta_m_deg": reference - error,
        "time.theta_ref_deg": reference,
        "time.following_error_min": error - 0.02,
        "time.following_error_max": error + 0.02,
        "time.speed_min": speed - 0.3,
        "time.speed_max": speed + 0.3,
        "time.tau_m_min": tau_m - 0.01,
        "time.tau_m_max": tau_m + 0.01,
        "time.tau_l_min": tau_l - 0.08,
        "time.tau_l_max": tau_l + 0.08,
        **free_output(theta, grid),
        "torsion.torque": cycle,
        "torsion.angle": torsion,
        "torsion.fit_torque": np.array([-15.0, 0.0, 15.0]),
        "torsion.fit_angle": np.array([-15.0, 0.0, 15.0]) / 7160 * 180 * 60 / np.pi,
        "lock.windup": torsion,
        "lock.torque": cycle,
        "lock.departure": cycle - torsion * 7160 / (180 * 60 / np.pi),
        "lock.fit_windup": np.array([-7.2, -5.3, -1.6, 1.6, 5.3, 7.2]),
        "lock.fit_torque": np.array([-15.0, -11.5, -3.2, 3.2, 11.5, 15.0]),
        "tangent.torque": np.linspace(-15, 15, 41),
        "tangent.fit": 7160 + 4.0 * np.linspace(-15, 15, 41) ** 2,
        "tangent.measured_torque": np.linspace(-13, 13, 27),
        "tangent.measured": 7160 + 4.0 * np.linspace(-13, 13, 27) ** 2 + rng.normal(0, 40, 27),
        "loop.rate": np.array([0.39, 0.4, 0.12, 0.12, 1.2, 1.21]),
        "loop.half_width": np.array([0.51, 0.5, 0.49, 0.48, 0.55, 0.56]),
        "loop.fit": np.array([0.48, 0.06]),
        "creep.time": np.geomspace(0.1, 2.0, 20),
        "creep.windup": 2.0 + 2.0 * np.log10(np.geomspace(0.1, 2.0, 20)),
    }


def free_output(theta: Array, grid: int) -> dict[str, Array]:
    """Curves of runs beside the slow one: at speed, over a whole output turn, at falling speeds, coasting."""
    n = np.arange(1.0, 16.0)
    total, pure = 1.2 * SERIES.value(np.radians(theta)), SERIES.value(np.radians(theta))
    around = np.linspace(0.0, 360.0, 8 * grid, endpoint=False)
    turn = SERIES.value(np.radians(50.0 * around)) + 3.0 * np.sin(np.radians(around))
    speed, t = np.array([4.8, 9.6, 15.0, 30.0, 60.0]), np.linspace(0.0, 0.15, 60)
    flexible = 0.2 * SERIES.amplitude
    coasts = np.outer(np.linspace(0.98, 1.02, 6), 500.0 * np.exp(-3.0 * t) - 350.0 * t / 0.15)
    return {
        "decomposition.theta_deg": theta,
        "decomposition.total": total,
        "decomposition.pure": pure,
        "decomposition.flexible": total - pure,
        "decomposition.order": n,
        "decomposition.measured": flexible,
        "decomposition.low": np.where(n < 13, 0.9 * flexible, 0.0),
        "decomposition.high": 1.1 * flexible,
        "decomposition.predicted": 1.02 * flexible,
        "turn.theta_l_deg": around,
        "turn.error": turn,
        "turn.accuracy": np.array([99.1, 98.5, 99.7]),
        "turn.order": np.array([0.02, 0.04, 1.0, 1.02, 2.0, 2.04, 4.0, 4.08]),
        "turn.amplitude": np.array([3.0, 0.0, 4.3, 0.2, 39.6, 1.0, 9.4, 0.1]),
        "turn.low": np.array([2.9, 0.0, 4.2, 0.1, 39.5, 0.9, 9.3, 0.0]),
        "turn.high": np.array([3.1, 0.1, 4.4, 0.3, 39.7, 1.1, 9.5, 0.2]),
        "convergence.speed_rpm": speed,
        "convergence.deviation": 1.6 * (speed / 60.0) ** 2,
        "convergence.u": np.full(5, 0.1),
        "convergence.law_rpm": np.geomspace(3.0, 100.0, 40),
        "convergence.law": 1.6 * (np.geomspace(3.0, 100.0, 40) / 60.0) ** 2,
        "convergence.tolerance": np.array([2.0]),
        "friction.rpm": np.array([-500.0, -100.0, -20.0, 20.0, 100.0, 500.0]),
        "friction.total": np.array([-0.49, -0.36, -0.33, 0.33, 0.36, 0.49]),
        "friction.motor": np.array([-0.46, -0.33, -0.31, 0.31, 0.33, 0.46]),
        "friction.line_rpm": np.concatenate((np.linspace(-500.0, -20.0, 20), np.linspace(20.0, 500.0, 20))),
        "friction.line": np.concatenate((np.linspace(-0.46, -0.31, 20), np.linspace(0.31, 0.46, 20))),
        "coast.t": t,
        "coast.speed_rpm": coasts,
        "coast.law_rpm": coasts.mean(axis=0),
    }


def coefficients() -> list[dict[str, float | str]]:
    """The table of a result, with made-up uncertainties; the last order is not told from zero."""
    rows: list[dict[str, float | str]] = []
    for n, a, b, c in zip(SERIES.orders, SERIES.a, SERIES.b, SERIES.amplitude, strict=True):
        u, resolved = 0.03 + 0.1 / n, n < 15
        row = {"order": n, "a_arcsec": a, "u_a": u, "b_arcsec": b, "u_b": u * 1.1, "C_arcsec": c}
        row |= {"C_lo": c - 2 * u if resolved else 0.0, "C_hi": c + 2 * u}
        row |= {"phase_deg": np.degrees(np.arctan2(b, a)), "u_phase": np.degrees(u / c)} if resolved else {}
        rows.append({key: float(value) for key, value in row.items()})
    return rows


def _loads() -> dict[str, Array]:
    """Three assemblies, two depths, four loads."""
    load = np.tile([0.0, 2.0, 7.5, 15.0], 3)
    depth, assembly = np.repeat([0.0, 0.0, 0.3], 4), np.repeat([1.0, 2.0, 3.0], 4)
    value = (1.0 - 0.5 * depth + 0.01 * assembly) * (45.0 + 45.0 * np.exp(-load / 2.5))
    band = 45.0 + 45.0 * np.exp(-load[:4] / 2.5)
    return {
        "load.load": load,
        "load.value": value,
        "load.low": value - 0.5,
        "load.high": value + 0.5,
        "load.depth_mm": depth,
        "load.assembly": assembly,
        "band.load": load[:4],
        "band.low": 0.97 * band,
        "band.high": 1.03 * band,
    }


def estimate(name: str, label: str, value: float, half: float, unit: str, how: str) -> Estimate:
    return Estimate(name, label, value, unit, (value - half, value + half), how)


def result(**changes: Any) -> Result:
    """A kinematic-error result with every kind of thing the page shows."""
    basis = "28 forward and 28 reverse revolutions, even part of both directions"
    told: dict[str, Any] = {
        "procedure": "kinematic_error",
        "verdict": Verdict.MEASURED,
        "sentence": "The kinematic error is 93.4 arcsec peak to peak per wave-generator turn, most of it order 2.",
        "estimates": (
            estimate(
                "kinematic_error_peak_to_peak",
                "Kinematic error, peak to peak",
                93.41,
                0.27,
                "arcsec",
                f"Peak to peak of the 15-order series over {basis}.",
            ),
            estimate("fourier_amplitude_2", "Amplitude of order 2", 39.62, 0.11, "arcsec", f"{basis}; least squares."),
            estimate("fourier_amplitude_4", "Amplitude of order 4", 9.36, 0.09, "arcsec", f"{basis}; least squares."),
            estimate(
                "direction_offset", "Direction offset", 28.83, 0.21, "arcsec", "Half of forward less reverse mean."
            ),
            estimate("trend_slope", "Trend along the output", 0.021, 0.034, "arcsec/deg", "Mean slope over 57.6°."),
            estimate("drift", "Drift with time", -0.12, 0.31, "arcsec/min", "Part of the means that follows time."),
            estimate("speed_scatter", "Speed scatter", 0.41, 0.0, "%", "1 σ over nominal, within the strokes."),
            Estimate("fourier_terms", "Orders worth keeping", 15, "1", (15, 15), "Smallest k below the noise floor."),
            Estimate("speed_agreed", "Fastest speed that agrees", 9.6, "rpm", (8.1, 14.2), "Search at falling speeds."),
        ),
        "checks": (
            Check("stuck_share", True, "Stuck (below 10 % of 9.60 rpm) for 0.00 % of the strokes, limit 2 %."),
            Check("speed_scatter", True, "Speed scatter 0.41 % of nominal (1 σ), limit 10 %."),
            Check("revolutions", False, "28 whole revolutions per direction, expected at least 35."),
        ),
        "cannot": (
            "Errors of one cycle per output turn: the run covers 57.6° of 360° of the output, they look like a trend.",
            "Order 2.00 apart from 2.04: that takes at least 25 turns in one direction, the longest stroke has 8.",
        ),
        "tables": {
            "coefficients": coefficients(),
            "strokes": [{"stroke": 1, "direction": "forward", "speed_rpm": 9.6}],
        },
        "curves": curves(),
    }
    return Result(**(told | changes))


def manifest(**changes: Any) -> dict[str, Any]:
    """A manifest as a session writes it."""
    told: dict[str, Any] = {
        "schema": "hdrig.run/1",
        "uid": "3f9c1e42-7d35-4f1e-9a55-0b8a5a3c9d11",
        "backend": "sim",
        "procedure": "kinematic_error",
        "status": "completed",
        "exit_reason": "the procedure came to its end",
        "started_utc": "2026-11-20T01:47:12.345678+00:00",
        "ended_utc": "2026-11-20T01:50:32.345678+00:00",
        "duration": 200.0,
        "gear": {"ratio": 50.0, "output": "flexspline", "serial": "TWIN-40-50"},
        "declared": {"J_m": 1.1e-3, "J_l": 0.32, "K": 7160.0, "B_sp": 3.6, "fourier_terms": 15},
        "conditions": {"tau_ext": 0.0, "output_locked": False, "speed_rpm": 9.6, "note": "first run after assembly"},
        "encoders": {"motor_counts_per_rev": 10000, "load_counts_per_rev": 900000},
        "devices": {"drive": {"model": "twin.drive", "serial": "T1", "firmware": "0.1.0"}},
        "software": {"version": "0.1.0", "commit": "a3bae8f3c0ffee", "dirty": True, "python": "3.11.9"},
        "host": "bench-3",
        "operator": "mg",
        "files": {
            "samples.parquet": {"sha256": "9f" * 32, "bytes": 8_412_331, "rows": 200_000},
            "bench.toml": {"sha256": "1c" * 32, "bytes": 5_803},
            "report.html": {"sha256": "00" * 32, "bytes": 1, "derived": True},
        },
    }
    return told | changes


TIMING: dict[str, Any] = {
    "clock": "wall",
    "period": 0.001,
    "ticks": 200_000,
    "missed_cycles": 2,
    "late_events": 1,
    "lateness_p50": 61e-6,
    "lateness_p99": 143e-6,
    "lateness_p999": 402e-6,
    "lateness_max": 2.61e-3,
    "how": "wake-up against the absolute deadline on the monotonic clock, every tick, 1 µs bins",
}

EVENTS: list[dict[str, Any]] = [
    {"t": None, "utc": "2026-11-20T01:47:12.345+00:00", "kind": "state", "text": "ready"},
    {"t": 0.0, "utc": "2026-11-20T01:47:13.1+00:00", "kind": "state", "text": "running: kinematic_error"},
    {"t": 200.0, "utc": "2026-11-20T01:50:33.1+00:00", "kind": "state", "text": "ready: the procedure came to its end"},
]
