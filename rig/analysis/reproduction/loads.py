"""Peak to peak of the slow kinematic error by load and assembly: the points of Figs. 9 and 10."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Number
from rig.analysis.reproduction.reading import Reading
from rig.analysis.reproduction.split import peak_to_peak

SAME_SPEED = 1.3  # runs whose speeds differ by more show the speed beside the load
SAME_LOAD = 0.02  # N·m


@dataclass(frozen=True)
class Point:
    """One run: |load| N·m, depth mm, assembly, peak to peak arcsec."""

    load: float
    depth_mm: float
    assembly: int
    size: Number


def points(campaign: Campaign) -> list[Point]:
    """Every slow run at the speed of the loaded ones, by load; empty when none is loaded."""
    slow = [(r, k) for r, k in campaign.slow() if r.procedure != "speed_convergence"]
    loaded = [k.speed_rpm for r, k in slow if r.tau_ext]
    if not loaded:
        return []
    usual = float(np.median(loaded))
    here = [(r, k) for r, k in slow if 1 / SAME_SPEED <= k.speed_rpm / usual <= SAME_SPEED]
    return sorted((_point(r, k) for r, k in here), key=lambda p: (p.assembly, p.load))


def _point(reading: Reading, error: KinematicError) -> Point:
    return Point(abs(reading.tau_ext), reading.depth_mm, reading.assembly, peak_to_peak(error))


def by_load(found: Sequence[Point]) -> list[tuple[float, Number]]:
    """Points of one load together: mean, with their own intervals and how far they lie apart."""
    groups: list[list[Point]] = []
    for point in sorted(found, key=lambda p: p.load):
        if groups and point.load - groups[-1][0].load <= SAME_LOAD:
            groups[-1].append(point)
        else:
            groups.append([point])
    return [(group[0].load, _mean([p.size for p in group])) for group in groups]


def _mean(sizes: Sequence[Number]) -> Number:
    values, halves = np.array([s.value for s in sizes]), np.array([s.half for s in sizes])
    apart = 0.5 * float(np.ptp(values))
    half = float(np.hypot(np.sqrt(np.mean(halves**2) / halves.size), apart))
    return Number.of(float(values.mean()), half, sizes[0].unit)


def drawn(found: Sequence[Point]) -> dict[str, Array]:
    """The points as curves, one entry a run."""
    columns = ("load", "depth_mm", "assembly")
    curves = {f"load.{name}": np.array([float(getattr(p, name)) for p in found]) for name in columns}
    ends = ("value", "low", "high")
    return curves | {f"load.{name}": np.array([getattr(p.size, name) for p in found]) for name in ends}
