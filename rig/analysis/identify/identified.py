"""The identified gear: parameters with intervals, what they come from, and what the campaign cannot tell apart."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.identify.dynamics import J_L, J_M, LAG, spring_columns
from rig.analysis.identify.fit import Fits
from rig.analysis.identify.friction import SLOW
from rig.analysis.identify.gains import disagreement
from rig.analysis.identify.mode import add_mode, damping_gradient
from rig.analysis.identify.possible import refuse_impossible, strange, taken_out
from rig.analysis.identify.solve import Solved
from rig.analysis.identify.undetermined import NOTHING, said_open, stand_in, undetermined
from rig.analysis.motion.declared import declared
from rig.core.errors import DataError
from rig.core.units import RPM
from rig.model.fourier import FourierSeries
from rig.model.gear import USUAL, output_of, sigma_of
from rig.model.gearfile import UNITS, GearFile, MeasuredSeries, Parameter

TOLD = 0.1  # of 1/K: with a standard error above that it is not told
AGREE = 3.0  # standard errors by which lock and turning runs may differ in stiffness
WORTH_TELLING = 0.005  # of K: a smaller difference is within what sensors and windows distort
BREAKAWAY = 1.0  # τ_s/τ_c assumed where nothing was seen of it: no fall of friction, so no stick-slip is predicted
STRIBECK = 1.0  # rad/s, written beside it; without a fall it has no effect
NEEDS = {
    "J_l": "runs at several speeds with torque sensor and load encoder",
    "K": "a lock run, or runs at several speeds, with torque sensor and load encoder",
    "J_m": "runs at several speeds with the drive's torque, torque sensor and load encoder",
}


PAIRS = (
    (
        ("B_m",),
        "B_m and B_ml: both drag on the motor alike; what is measured is their sum B_m + B_ml·(1 + σ/N)². "
        "A friction run with the wave generator out gives B_m alone.",
    ),
    (
        ("B_sp",),
        "B_sp and B_ml: B_ml drags beside the spring, with a fiftieth of its lever; it was taken as declared to a "
        "third, else as anything up to the whole drag, and the interval of B_sp says so.",
    ),
    (
        ("B_m",),
        "B_ml and a delay between the encoders: both add to the mean of θ̃ in proportion to the speed; neither is "
        "taken from it.",
    ),
    (("B_l",), "B_l and what B_ml drags behind the torque sensor: the sensor sees only what passes through it."),
    (("K",), "K of the gear and of what lies in series (torque sensor, couplings, lock): K is of the whole path."),
    (
        ("K", "J_l", "B_l", "B_sp", "F_cl", "J_m", "B_m", "tau_c"),
        "K, J_l, B_l, B_sp, F_cl and the gain of the torque sensor: all of them scale with it. Likewise J_m, B_m, "
        "tau_c and the torque constant of the drive. Gains were taken as exact.",
    ),
    ((), "Order 1 of the wave generator and an eccentric motor encoder: re-clock the encoder to tell them apart."),
    ((), "a_0: the zero of the encoders is arbitrary, the constant of θ̃_p was left out."),
)
"""What no campaign tells apart, with the parameters that it concerns; none named: whatever was measured."""


@dataclass(frozen=True)
class Identified:
    """Parameters by name (those of the gear file and B_sum, omega_n, zeta, lag, skew), θ̃_p, and what cannot be told."""

    parameters: Mapping[str, Parameter]
    series: MeasuredSeries
    cannot: tuple[str, ...]
    fits: Fits
    undetermined: tuple[str, ...] = ()  # names of what a complete identification has and no run here measured
    output: str = USUAL  # the part that was the output, by which the sums of drag were read
    doubtful: bool = False  # two sensors contradict each other: one of them, and what goes by it, is wrong

    def gear_file(self, serial: str, simulated: bool, made: str, lacking: Sequence[str] = ()) -> GearFile:
        """What goes on disk. Raises DataError when inertias or stiffness are neither measured nor declared, with the
        channels that are `lacking` in all runs."""
        missing = [name for name in ("J_m", "J_l", "K") if name not in self.parameters]
        if missing:
            none_of = f"; no run here has {' or '.join(lacking)}" if lacking else ""
            raise DataError(
                f"{missing[0]} is neither measured here nor declared in the runs: no gear file; take "
                f"{NEEDS[missing[0]]}{none_of}"
            )
        kept = {name: self.parameters[name] for name in UNITS}
        open_ = [said_open(self.undetermined, kept)] if self.undetermined else []
        return GearFile(kept, self.series, self.output, serial, simulated, made, (*open_, *self.cannot))


def identified(fits: Fits, manifest: Mapping[str, Any]) -> Identified:
    """From the fits to parameters; what they lack is taken from the runs' `declared`, else assumed and said so.

    Raises DataError where an inertia or a friction comes out negative.
    """
    said = manifest.get("declared") or {}
    output = output_of((manifest.get("gear") or {}).get("output"))
    sigma = sigma_of(output)
    found: dict[str, Parameter] = {"N": Parameter(fits.ratio, origin="declared")}
    cannot: list[str] = []
    _spring(found, cannot, fits)
    _load(found, cannot, fits)
    _motor(found, cannot, fits, said, sigma)
    refuse_impossible(found)
    cannot += [*strange(found, said), *taken_out(found)]
    apart = disagreement(fits.means, fits.ratio)
    cannot += [apart] if apart else []
    cannot += stand_in(found, fits, said, sigma)
    if "tau_s" not in found:
        unknown = found["tau_c"].note == NOTHING
        note = NOTHING if unknown else _no_fall(fits)
        found["tau_s"] = Parameter(BREAKAWAY * found["tau_c"].value, origin="assumed", note=note)
        found["omega_s"] = Parameter(STRIBECK, origin="assumed", note="without effect as long as tau_s equals tau_c")
    add_mode(found, fits)
    series = _series(fits, cannot)
    told = (*cannot, *_always(found))
    return Identified(found, series, told, fits, undetermined(found, series), output, bool(apart))


def _no_fall(fits: Fits) -> str:
    """Why tau_s is taken as tau_c: slow runs on the line of fast ones, or too few speeds to tell how they leave it."""
    if fits.motor_friction is not None and fits.motor_friction.doubt:
        return "slow runs rub otherwise than fast ones, too few speeds to tell how: no fall assumed"
    return "no fall of friction with speed was seen: none assumed"


def _measured(value: float, u: float, solved: Solved, runs: tuple[str, ...], note: str = "") -> Parameter:
    half = t95(solved.dof) * u
    return Parameter(float(value), (float(value - half), float(value + half)), "measured", runs, note)


def _spring(found: dict[str, Parameter], cannot: list[str], fits: Fits) -> None:
    """K, B_sp and how late the load encoder reads."""
    spring, (at_K, at_damping, at_delay, _) = fits.spring, spring_columns(fits.terms)
    if spring is None or spring.coefficients[at_K] <= 0.0 or not spring.u(at_K) < TOLD * spring.coefficients[at_K]:
        alone = fits.locked and not fits.slow
        doubt = "the kinematic error over the few degrees a locked motor turns looks the same" if alone else ""
        needs = "a slow run beside the lock test" if alone else NEEDS["K"]
        cannot.append(f"Stiffness K: {doubt or 'nothing here shows it'}; it takes {needs}.")
        return
    c, K = spring.coefficients, 1.0 / spring.coefficients[at_K]
    running = tuple(dict.fromkeys(w.run for w in fits.windows))
    found["K"] = _stiffness(fits, K, cannot, (*fits.locked, *running))
    if fits.windows and fits.load is not None:
        grad = damping_gradient(fits)
        u = float(np.sqrt(grad @ spring.covariance @ grad + _of_mesh(fits) ** 2))
        found["B_sp"] = _measured(c[at_damping] * K, u, spring, running)
        found["skew"] = _measured(c[at_delay] + fits.taken_off, spring.u(at_delay), spring, running)
    else:
        cannot.append("B_sp: only runs at several speeds show the damping of the spring.")


def _of_mesh(fits: Fits) -> float:
    """1 σ of B_sp [N·m·s/rad] from what is not known of B_ml: it drags beside the spring, N times the motor's share."""
    J_m = fits.motor.coefficients[J_M] if fits.motor is not None else 0.0
    J_l = fits.load.coefficients[J_L] if fits.load is not None else 0.0
    share = J_l / (J_l + fits.ratio**2 * J_m) if J_m > 0.0 else 0.0
    return float(fits.ratio * share * fits.mesh.half_range / np.sqrt(3.0))


def _stiffness(fits: Fits, K: float, cannot: list[str], runs: tuple[str, ...]) -> Parameter:
    """K; where lock and turning runs contradict each other the interval spans both."""
    at_K = spring_columns(fits.terms)[0]
    assert fits.spring is not None
    half = fits.spring.half(at_K) * K * K
    low, high, note = K - half, K + half, ""
    a, b = fits.lock_only, fits.running_only
    if a is not None and b is not None and min(a.coefficients[at_K], b.coefficients[at_K]) > 0.0:
        apart = abs(a.coefficients[at_K] - b.coefficients[at_K]) / float(np.hypot(a.u(at_K), b.u(at_K)))
        at_rest, turning = 1.0 / a.coefficients[at_K], 1.0 / b.coefficients[at_K]
        if apart > AGREE and abs(at_rest / turning - 1.0) > WORTH_TELLING:
            low, high = min(low, at_rest, turning), max(high, at_rest, turning)
            note = f"lock {at_rest:.0f}, turning {turning:.0f} N·m/rad: they contradict each other"
            cannot.append(
                f"Stiffness: the lock runs say {at_rest:.0f} N·m/rad, the turning runs {turning:.0f} N·m/rad, "
                f"{apart:.0f} standard errors apart: the spring is no straight line (soft wind-up, hysteresis, an "
                "error that depends on load), and K stands for both only roughly."
            )
    return Parameter(float(K), (float(low), float(high)), "measured", runs, note)


def _load(found: dict[str, Parameter], cannot: list[str], fits: Fits) -> None:
    """J_l, B_l, F_cl, the sensor's lag behind the load encoder."""
    if fits.load is not None:
        running = tuple(dict.fromkeys(w.run for w in fits.windows))
        found["J_l"] = _measured(fits.load.coefficients[J_L], fits.load.u(J_L), fits.load, running)
        lag = fits.load.coefficients[LAG] - fits.taken_off  # behind load angles as recorded: the fit had them in step
        found["lag"] = _measured(lag, fits.load.u(LAG), fits.load, running)
    else:
        cannot.append(f"J_l: it takes {NEEDS['J_l']}.")
    friction = fits.load_friction
    if friction is None:
        return  # what of them is known is said with what stands in for them
    s, runs = friction.solved, tuple(dict.fromkeys(m.run for m in friction.rows))
    found["B_l"] = _measured(s.coefficients[friction.B_l], s.u(friction.B_l), s, runs)
    if friction.zero is None:
        cannot.append("F_cl: only one direction was run, the zero of the torque sensor looks the same.")
    else:
        found["F_cl"] = _measured(s.coefficients[friction.F_cl], s.u(friction.F_cl), s, runs)
        found["zero"] = _measured(s.coefficients[friction.zero], s.u(friction.zero), s, runs)


def _motor(found: dict[str, Parameter], cannot: list[str], fits: Fits, said: Mapping[str, Any], sigma: int) -> None:
    """J_m, the motor's drag as a sum, Coulomb and falling friction."""
    friction = fits.motor_friction
    if friction is None:
        return
    s, runs = friction.solved, tuple(dict.fromkeys(m.run for m in friction.rows))
    total, u = float(s.coefficients[friction.B]), s.u(friction.B)
    found["B_sum"] = _measured(total, u, s, runs, "B_m + B_ml·(1 + σ/N)²")
    B_ml = declared(said, "B_ml") or 0.0
    share = B_ml * (1.0 + sigma / fits.ratio) ** 2
    if share >= total:
        B_ml, share = 0.0, 0.0
    found["B_ml"] = Parameter(B_ml, origin="declared" if B_ml else "assumed", note="cannot be told from B_m")
    note = "the measured sum less the share of B_ml" if B_ml else "the measured sum, what the mesh drags in it"
    found["B_m"] = _measured(total - share, u, s, runs, note)
    found["tau_c"] = _measured(s.coefficients[friction.tau_c], s.u(friction.tau_c), s, runs)
    if not friction.both_ways:
        cannot.append("tau_c: only one direction was run, a constant offset of the drive's torque looks the same.")
    if friction.fall is not None:
        top = s.coefficients[friction.tau_c] + s.coefficients[friction.fall]
        cov = s.covariance
        both = cov[friction.tau_c, friction.tau_c] + cov[friction.fall, friction.fall]
        both += 2.0 * cov[friction.tau_c, friction.fall]
        note = "extrapolated to standstill along the curve; breakaway itself may differ"
        found["tau_s"] = _measured(top, float(np.sqrt(max(both, 0.0))), s, runs, note)
        found["omega_s"] = Parameter(friction.omega_s, runs=runs, note="chosen from a grid, no interval")
    elif friction.doubt:
        cannot.append(friction.doubt)
    if friction.bend:
        cannot.append(friction.bend)
    _motor_inertia(found, cannot, fits)


def _motor_inertia(found: dict[str, Parameter], cannot: list[str], fits: Fits) -> None:
    """J_m, where the motor speeds up and slows down by more than its encoder's noise seems to make it."""
    if fits.motor is None:
        cannot.append(f"J_m: it takes {NEEDS['J_m']}.")
        return
    running = tuple(dict.fromkeys(w.run for w in fits.windows))
    J_m = _measured(fits.motor.coefficients[J_M], fits.motor.u(J_M), fits.motor, running)
    if J_m.interval[0] <= 0.0 <= J_m.interval[1]:
        why = "its 95 % interval holds zero, the motor hardly speeds up or slows down in these runs"
        cannot.append(f"J_m cannot be told: {why}; it takes {NEEDS['J_m']}.")
        return
    found["J_m"] = J_m


def _series(fits: Fits, cannot: list[str]) -> MeasuredSeries:
    size, runs = 2 * fits.terms, tuple(s.run for s in fits.slow) + tuple(dict.fromkeys(w.run for w in fits.windows))
    if fits.spring is None or not runs:
        cannot.append("Kinematic error: no slow run and no run at speed gives it; it is left out.")
        none = FourierSeries((0.0,) * fits.terms, (0.0,) * fits.terms)
        return MeasuredSeries(none, np.full((size, size), np.nan), "assumed", note="not determined by these runs")
    return MeasuredSeries(fits.series, fits.spring.covariance[:size, :size], "measured", runs)


def order_amplitudes(series: MeasuredSeries) -> list[tuple[int, float, float]]:
    """(n, C_n, 1 σ), rad at the output."""
    s, V, k = series.series, series.covariance, len(series.series.a)
    out = []
    for n in range(k):
        size = float(np.hypot(s.a[n], s.b[n])) or 1e-300
        g = np.array([s.a[n], s.b[n]]) / size
        part = V[np.ix_([n, n + k], [n, n + k])]
        out.append((n + 1, size, math.sqrt(max(float(g @ part @ g), 0.0))))
    return out


def order_phases(series: MeasuredSeries) -> list[tuple[float, float]]:
    """(ψ_n, 1 σ) of the same orders, rad: what the covariance has across the phasor, over its length."""
    s, V, k = series.series, series.covariance, len(series.series.a)
    out = []
    for n in range(k):
        size = float(np.hypot(s.a[n], s.b[n])) or 1e-300
        across = np.array([-s.b[n], s.a[n]]) / size
        part = V[np.ix_([n, n + k], [n, n + k])]
        out.append((float(s.phase[n]), math.sqrt(max(float(across @ part @ across), 0.0)) / size))
    return out


def _always(found: Mapping[str, Parameter]) -> list[str]:
    """What no such campaign can tell apart, each pair named; pairs of which nothing was measured are left out."""
    said = [
        text for names, text in PAIRS if not names or any(n in found and found[n].origin == "measured" for n in names)
    ]
    if found["tau_s"].origin != "measured":
        said.append(
            "tau_s and omega_s: breakaway and the speed over which friction falls need at least three speeds held "
            f"constant below {SLOW / RPM:.0f} rpm at which friction is seen to fall; only stretches of constant speed "
            "are read for it here. hdrig trace reads every row, and may name Stribeck friction in the same runs."
        )
    return said
