"""All runs of a campaign to one gear: the equations solved in turn, each leaning on what the others have found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import chain

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.identify.dynamics import (
    J_L,
    J_M,
    LAG,
    Mesh,
    Q,
    Sensor,
    load_fit,
    motor_fit,
    spring_columns,
)
from rig.analysis.identify.friction import LoadFriction, MotorFriction, load_friction, motor_friction
from rig.analysis.identify.means import Mean, Sides, mean_of
from rig.analysis.identify.recording import Plateau, Recording, plateaus
from rig.analysis.identify.slow import SlowSeries, slow_series
from rig.analysis.identify.solve import Solved
from rig.analysis.identify.spring import SpringRuns
from rig.analysis.identify.stretches import stretches
from rig.analysis.identify.windows import Projected, project
from rig.analysis.motion.declared import declared
from rig.model.fourier import FourierSeries
from rig.model.gear import sigma_of

MATTERS = 5e-5  # s of delay between the encoders: less is taken off by the fit itself to a part in 10⁴
SURE = 4.0  # standard errors


@dataclass(frozen=True)
class Fits:
    """What each equation gave; None where the campaign has nothing for it. SI."""

    terms: int
    ratio: float
    series: FourierSeries
    slow: tuple[SlowSeries, ...]
    means: tuple[Mean, ...]
    windows: tuple[Projected, ...]
    spring: Solved | None  # columns of dynamics.spring_columns
    lock_only: Solved | None  # the same without the turning runs
    running_only: Solved | None  # the same without the lock runs
    load: Solved | None
    motor: Solved | None
    motor_friction: MotorFriction | None
    load_friction: LoadFriction | None
    locked: tuple[str, ...]  # names of the lock runs used
    mesh: Mesh
    taken_off: float = 0.0  # s by which the load encoder's readings were moved before the final fit


def fit(runs: Sequence[Recording], terms: int, progress: Callable[[str], None] = lambda text: None) -> Fits:
    """Solve the campaign. `terms` orders of θ̃_p; `progress` is told what is being done."""
    ratio = runs[0].ratio
    progress("slow runs")
    slow = tuple(s for r in runs if (s := slow_series(r, terms)) is not None)
    level = list(chain.from_iterable(plateaus(r) for r in runs))
    series = _mean_series(slow, terms)
    fits = _once(runs, level, slow, series, terms, ratio, progress)
    late = _late(fits)
    if late:  # a delay too long for the straight line it was found with: read the load encoder when it was meant
        runs = [r.with_load_late_by(late) for r in runs]
        slow = tuple(s for r in runs if (s := slow_series(r, terms)) is not None)
        level = list(chain.from_iterable(plateaus(r) for r in runs))
    if late or (not slow and fits.spring is not None):  # or the lever of the shaft torque was not known yet
        fits = _once(runs, level, slow, fits.series, terms, ratio, progress)
    return replace(fits, taken_off=late)


def _late(fits: Fits) -> float:
    """How late the load encoder reads [s], 0 when too little to matter or too uncertain."""
    if fits.spring is None or not fits.windows:
        return 0.0
    place = spring_columns(fits.terms)[2]
    delay, u = float(fits.spring.coefficients[place]), fits.spring.u(place)
    return delay if abs(delay) > max(MATTERS, SURE * u) else 0.0


def _once(
    runs: Sequence[Recording], level: Sequence[Plateau], slow: tuple[SlowSeries, ...], series: FourierSeries,
    terms: int, ratio: float, progress: Callable[[str], None],
) -> Fits:  # fmt: skip
    progress(f"{len(level)} stretches of constant speed")
    spans = stretches(level)
    means = [mean_of(p, series, Sides()) for p in spans]
    friction_l = load_friction(means, ratio)
    slopes = {id(r): series.slope(r.theta_m) for r in runs}
    windows = [w for p in level if (w := project(p, terms, slopes[id(p.run)])) is not None]
    drag_l = None if friction_l is None else (friction_l.solved.coefficients[friction_l.B_l], friction_l.solved.u(0))
    load = load_fit(windows, drag_l)
    progress("spring")
    friction_m = motor_friction(means)
    mesh = _mesh(runs[0], friction_m)
    sensor, J_l = Sensor(), 0.0
    if load is not None:
        sensor, J_l = Sensor(load.coefficients[LAG], load.coefficients[Q]), load.coefficients[J_L]
    locked = [r for r in runs if r.locked]
    begin = np.array([*series.a, *series.b])
    springs = SpringRuns(windows, slow, locked, terms, mesh, J_l, begin)
    spring = springs.solve_doubting(sensor, load)
    lock_only = replace(springs, windows=()).solve(sensor) if locked and slow else None
    running_only = replace(springs, locked=()).solve_doubting(sensor, load) if windows else None
    if spring is not None:
        series = _series(spring, terms)
        sensor = replace(sensor, lag=sensor.lag + spring.coefficients[spring_columns(terms)[2]])
    progress("motor")
    J_m, motor = 0.0, None
    if friction_m is not None:
        drag_m = (friction_m.solved.coefficients[friction_m.B], friction_m.solved.u(friction_m.B))
        motor = motor_fit(windows, ratio, sensor, mesh, np.array([*series.a, *series.b]), drag_m)
        J_m = motor.coefficients[J_M] if motor is not None else 0.0
    means = [mean_of(p, series, _sides(J_m, friction_m, J_l, friction_l)) for p in spans]
    used = tuple(r.name for r in locked if r.tau_l is not None)
    return Fits(
        terms, ratio, series, slow, tuple(means), tuple(windows), spring, lock_only, running_only, load, motor,
        motor_friction(means), load_friction(means, ratio), used, mesh,
    )  # fmt: skip


def _sides(J_m: float, motor: MotorFriction | None, J_l: float, load: LoadFriction | None) -> Sides:
    """What the first means and the windows have told, for the second means."""
    B = 0.0 if motor is None else float(motor.solved.coefficients[motor.B])
    B_l = 0.0 if load is None else float(load.solved.coefficients[load.B_l])
    return Sides(J_m, B, J_l, B_l)


def _mesh(run: Recording, friction: MotorFriction | None) -> Mesh:
    """B_ml as declared, to a third; else anything from none to all of the measured drag."""
    sigma = sigma_of((run.source.manifest.get("gear") or {}).get("output"))
    most = 0.0 if friction is None else max(float(friction.solved.coefficients[friction.B]), 0.0)
    said = declared(run.source.declared, "B_ml")
    if said is not None and said <= most:
        return Mesh(said, said / 3.0, sigma)
    return Mesh(0.5 * most, 0.5 * most, sigma)


def _mean_series(slow: Sequence[SlowSeries], terms: int) -> FourierSeries:
    """The slow runs' coefficients, weighted; zeros without any."""
    if not slow:
        return FourierSeries((0.0,) * terms, (0.0,) * terms)
    weights = np.array([1.0 / np.maximum(s.u, 1e-12) ** 2 for s in slow])
    return _from(np.sum(weights * np.array([s.coefficients for s in slow]), axis=0) / np.sum(weights, axis=0), terms)


def _series(spring: Solved, terms: int) -> FourierSeries:
    return _from(spring.coefficients[: 2 * terms], terms)


def _from(c: Array, terms: int) -> FourierSeries:
    return FourierSeries(tuple(map(float, c[:terms])), tuple(map(float, c[terms : 2 * terms])))
