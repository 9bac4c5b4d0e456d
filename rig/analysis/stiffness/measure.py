"""A lock test as numbers: wind-up less the kinematic error, spring, loop, creep."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import t95
from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.stiffness.branches import Hold, Ramp, cut
from rig.analysis.stiffness.counts import of_width
from rig.analysis.stiffness.creep import Creep, creep
from rig.analysis.stiffness.curve import Curve, scale_of
from rig.analysis.stiffness.laws import Scale
from rig.analysis.stiffness.loop import SAME, Value, Width, energy, energy_of, gap, widths
from rig.analysis.stiffness.points import Points, points_of
from rig.analysis.stiffness.shape import Shape, open_points, shape_of
from rig.analysis.stiffness.share import Share, reference_fits, share_of
from rig.analysis.stiffness.spring import Spring, spring_of
from rig.analysis.stiffness.tilt import Tilt, with_reference, without_reference
from rig.model.fourier import FourierSeries
from rig.model.transmission_error import transmission_error

SENSOR_GAIN = 0.002  # 95 %, of the torque: a sensor of class 0.2
FEWEST = 40  # points, a quarter of one whole ramp
SECANT = 0.95  # of the smaller end torque: where the secant is taken, so that both ends reach it
UNFIT = "The reference does not fit this run (was the motor angle's zero another?) and was not used. "


@dataclass(frozen=True)
class Cut:
    """The run as the fits see it. Arrays (n,)."""

    windup: Array  # rad, less what is known of the kinematic error
    tau: Array  # N·m
    t: Array | None
    ramps: list[Ramp]
    holds: list[Hold]
    points: Points
    scale: Scale
    shape: Shape

    @property
    def open(self) -> Points:
        """Where the loop has opened: there the branches differ by a constant, whatever opens it."""
        return open_points(self.points, self.shape)


@dataclass(frozen=True)
class Stiffness:
    """All numbers of one lock test."""

    run: Cut
    spring: Spring
    share: Share | None  # of the reference; None without one
    tilt: Tilt
    tau_ref: float  # N·m where the secant is taken
    widths: list[Width]
    gap: Value | None  # rad
    energy: Value  # J per cycle
    loops: int  # closed loops behind the energy; 0: from the fitted loop
    creep: Creep | None
    count: float  # rad at the output, one of the motor's encoder; 0 unknown


def windup_of(motion: Motion) -> Array:
    """θ_m/N − θ_l [rad], the load angle 0 where none was measured."""
    load = motion.theta_l if motion.theta_l is not None else np.zeros_like(motion.theta_m)
    return transmission_error(motion.theta_m, load, motion.ratio)


def cut_run(motion: Motion, tau: Array, error: Array) -> Cut | None:
    """Ramps and points of a run less `error` rad; None when it has too few."""
    windup = windup_of(motion) - error
    ramps, holds = cut(windup, tau, motion.t)
    points = points_of(ramps, windup, tau, error, motion.t)
    if points.tau.size < FEWEST or not points.reach > 0:
        return None
    scale = scale_of(points)
    return Cut(windup, tau, motion.t, ramps, holds, points, scale, shape_of(points, scale.K))


def measure(
    motion: Motion, tau: Array, reference: FourierSeries | None, knots: tuple[float, float] | None, count: float = 0.0
) -> Stiffness | None:
    """Everything a lock test says; None without a ramp long enough. `knots` T1, T2 N·m where the bench has them;
    `count` rad at the output is one of the motor's encoder.
    """
    run, share = _less_reference(motion, tau, reference)
    if run is None:
        return None
    spring = spring_of(run.open, run.scale, run.shape, knots)
    curve = spring.chosen.curve
    if share is not None:
        tilt = with_reference(run.points, share, spring.lines_out.curve)
    else:
        swing = float(np.ptp(motion.theta_m)) / 2
        tilt = without_reference(motion.ratio, swing, "" if reference is None else UNFIT)
    found = widths(run.ramps, curve, run.windup, run.tau)
    main = [w for w in found if not abs(w.rate / found[0].rate - 1.0) > SAME]
    width = _gap(main, curve, count)
    joules, loops = _energy(run, spring, width, count)
    ends = np.abs(curve.torque(np.array([run.points.windup.min(), run.points.windup.max()])))
    held = creep(run.holds, curve, run.windup, run.tau, run.t)
    return Stiffness(run, spring, share, tilt, SECANT * float(ends.min()), found, width, joules, loops, held, count)


def _less_reference(motion: Motion, tau: Array, reference: FourierSeries | None) -> tuple[Cut | None, Share | None]:
    plain = cut_run(motion, tau, np.zeros_like(tau))
    if reference is None or plain is None:
        return plain, None
    error = reference.value(motion.theta_m)
    run = cut_run(motion, tau, error)
    if run is None or not reference_fits(run.open, run.scale, run.shape):
        return plain, None
    share = share_of(run.open, run.scale, run.shape)
    return cut_run(motion, tau, share.value * error), share


def _gap(main: list[Width], curve: Curve, count: float) -> Value | None:
    found = gap(main, curve)
    return None if found is None else Value(found.value, float(np.hypot(found.half, of_width(count))))


def _energy(run: Cut, spring: Spring, width: Value | None, count: float) -> tuple[Value, int]:
    """Loss per cycle at the first rate, and from how many loops; from the fitted loop when the run closes none.

    One loop shows no scatter of its own: what its width may be off by at zero torque then stands for it, over the
    whole range.
    """
    first = next((r for r in run.ramps if r.on_loop), run.ramps[0]).rate
    areas = [area for rate, area in energy(run.ramps, run.points) if not abs(rate / first - 1.0) > SAME]
    n, span = len(areas), float(np.ptp(run.points.tau))
    if n > 1:
        scatter = t95(n - 1) * float(np.std(areas, ddof=1)) / np.sqrt(n)
        return Value(float(np.mean(areas)), float(np.hypot(scatter, of_width(count) * span))), n
    half = float("nan") if width is None else width.half * span
    if n == 1:
        return Value(areas[0], half), 1
    return Value(energy_of(spring.chosen.curve, 0.0 if np.isnan(first) else first), half), 0
