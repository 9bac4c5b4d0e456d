"""Kinematic error of a run as numbers: strokes to revolutions to one profile and one trend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.flexibility import added_share
from rig.analysis.kinematic_error.profile import Profile, combine
from rig.analysis.kinematic_error.trend import Trend, find_trend
from rig.analysis.motion.declared import declared
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.strokes import Stroke
from rig.analysis.orders.revolutions import ROWS_PER_TERM, StrokeResult, analyse_stroke
from rig.core.units import RPM, TURN
from rig.model.fourier import PAPER_ORDERS

SAME_SPEED = 1.15  # strokes whose speeds differ by less are averaged together


@dataclass(frozen=True)
class KinematicError:
    """All numbers of one run's kinematic error, arcsec at the output."""

    profile: Profile
    trend: Trend
    strokes: list[StrokeResult]
    speed_rpm: float  # mean of the magnitude; NaN without time
    added: Array  # (k,) share of each amplitude that inertia may have added; zeros when J_l or K is unknown
    added_known: bool
    u_zero: float  # rad, 1 σ of where the motor angle's zero is: one count wide; 0 when its counts are unknown


def measure(run: Source, motion: Motion, strokes: list[Stroke], slow: bool) -> KinematicError | None:
    """The kinematic error over the given strokes, all of one speed; None when the rows are too few for one order.

    `slow`: the figures stand for the pure kinematic error, so what inertia adds belongs into their uncertainty.
    """
    rows = min(int(np.min(np.diff(s.edges))) for s in strokes)
    terms = min(PAPER_ORDERS, rows // ROWS_PER_TERM)
    if terms < 1:
        return None
    results = [analyse_stroke(motion, s, terms) for s in strokes]
    speeds = np.abs(np.concatenate([s.speed_rpm for s in results]))
    speed = float(np.mean(speeds))
    K, J_l = declared(run.declared, "K"), declared(run.declared, "J_l")
    orders = np.arange(1.0, terms + 1)
    known = slow and K is not None and J_l is not None and bool(np.isfinite(speed))
    added = added_share(orders, speed * RPM, K, J_l) if known and K and J_l else np.zeros(terms)
    trend = find_trend(results, motion.ratio, motion.t is not None)
    counts = declared(run.manifest.get("encoders") or {}, "motor_counts_per_rev")
    u_zero = TURN / counts / np.sqrt(12.0) if counts else 0.0
    return KinematicError(combine(results, added), trend, results, speed, added, known, float(u_zero))


def pieces_of_one_speed(motion: Motion, stroke: Stroke) -> list[Stroke]:
    """A stroke cut between revolutions where its speed changes: run-up, plateaus of a staircase, run-down."""
    t, theta, edges = motion.t, motion.theta_m, stroke.edges
    if t is None or stroke.revolutions < 2:
        return [stroke]
    speed = np.abs(np.diff(theta[edges]) / np.diff(t[edges]))
    cuts, since = [0], 0
    for r in range(1, speed.size):
        usual = float(np.mean(speed[since:r]))
        if not usual / SAME_SPEED <= speed[r] <= usual * SAME_SPEED:
            cuts.append(r)
            since = r
    if len(cuts) == 1:
        return [stroke]
    return [_part(stroke, a, b) for a, b in zip(cuts, [*cuts[1:], speed.size], strict=True)]


def _part(stroke: Stroke, first: int, last: int) -> Stroke:
    """The revolutions first..last−1 of a stroke as a stroke of its own."""
    edges = stroke.edges[first : last + 1]
    return Stroke(stroke.direction, int(edges[0]), int(edges[-1]) + 1, edges)


def groups_by_speed(motion: Motion, strokes: list[Stroke]) -> list[list[Stroke]]:
    """Strokes of one speed together, slowest first; one group without time."""
    if motion.t is None:
        return [strokes]
    parts = [p for s in strokes for p in pieces_of_one_speed(motion, s)]
    speeds = [abs(motion.speed_rpm(int(s.edges[0]), int(s.edges[-1]))) for s in parts]
    groups: list[list[Stroke]] = []
    slowest = 0.0
    for i in np.argsort(speeds):
        if not groups or speeds[i] > SAME_SPEED * slowest:
            groups.append([])
            slowest = speeds[i]
        groups[-1].append(parts[i])
    return [sorted(g, key=lambda s: s.start) for g in groups]
