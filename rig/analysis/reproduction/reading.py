"""One run cut down to what the figures need of it: small enough to be sent from one process to another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rig.analysis.analyse import analyse
from rig.analysis.findings.result import Array, Result
from rig.analysis.kinematic_error.measure import KinematicError, groups_by_speed, measure
from rig.analysis.kinematic_error.ratio import disagreement
from rig.analysis.motion.source import Motion, Source, motion_of
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.analysis.motion.tame import Tame
from rig.analysis.motion.window import measured_window, part
from rig.analysis.reproduction.shaft import Shaft, shaft_of
from rig.analysis.reproduction.waveform_spectrum import Spectrum, spectrum_of
from rig.analysis.reproduction.ways import Way, ways_of
from rig.analysis.smoothness.measure import smoothness
from rig.analysis.smoothness.words import sentence
from rig.core.kinds import Regime, regime_of
from rig.core.numbers import number
from rig.runfile.run import Run

FAST = 60.0  # rpm: from here a run shows what speed does, below it the pure error and how slow is slow enough
FEWEST = 2  # revolutions of one speed


@dataclass(frozen=True)
class Reading:
    """A run without its rows. To the analysis it is a Source that recorded nothing more."""

    name: str
    manifest: Mapping[str, Any]
    ratio: float
    procedure: str
    misfits: tuple[str, ...] = ()
    slow: tuple[KinematicError, ...] = ()  # one for each speed below FAST at which it ran smoothly, slowest first
    rejected: tuple[str, ...] = ()  # why the others do not count
    fast: KinematicError | None = None  # over the settled part at the speed held longest
    shaft: Shaft | None = None  # the torque sensor over the same part
    spectrum: Spectrum | None = None
    torque: float = float("nan")  # N·m, constant command
    lock: Result | None = None
    ways: tuple[Way, ...] = ()  # of a slow run, at the speed of most turns

    def column(self, name: str) -> Array | None:
        """None: the rows stayed in the run folder."""
        return None

    def has(self, name: str) -> bool:
        """False"""
        return False

    @property
    def conditions(self) -> Mapping[str, Any]:
        """What was set for the run."""
        return self.manifest.get("conditions") or {}

    @property
    def declared(self) -> Mapping[str, Any]:
        """What was believed of the gear."""
        return self.manifest.get("declared") or {}

    @property
    def tau_ext(self) -> float:
        """N·m on the load."""
        return number(self.conditions.get("tau_ext"), 0.0)

    @property
    def speed_rpm(self) -> float:
        """What it was meant to turn at, either way; NaN where that is not said."""
        return abs(number(self.conditions.get("speed_rpm"), math.nan))

    @property
    def assembly(self) -> int:
        """Which fitting of the wave generator; 1 where none is said."""
        return int(number(self.conditions.get("assembly"), 1.0))

    @property
    def depth_mm(self) -> float:
        """From the reference depth, deeper is positive."""
        return number(self.conditions.get("depth_mm"), 0.0)


def read(folder: Path, reference: Path | None = None) -> Reading:
    """The run in `folder`; from a lock test the kinematic error of `reference` is taken off. Raises HdrigError."""
    return reading_of(Run.open(folder), None if reference is None else Run.open(reference))


def reading_of(run: Source, reference: Source | None = None) -> Reading:
    """What the figures need of `run`."""
    bare = Reading(run.name, dict(run.manifest), run.ratio, run.procedure, tuple(run.misfits))
    with np.errstate(all="ignore"):
        if bare.conditions.get("output_locked"):
            return replace(bare, lock=analyse(run, reference))
        if regime_of(run.procedure) is Regime.LOSSES:  # for identification alone
            return bare
        tame = Tame(run)
        motion = motion_of(tame)
        if motion is None or motion.theta_l is None or motion.theta_m.size < 16 or disagreement(motion):
            return bare
        return _turning(bare, tame, motion)


def _turning(bare: Reading, run: Tame, motion: Motion) -> Reading:
    groups = _groups(motion)
    if not groups:
        return bare
    if abs(motion.speed_rpm(*_ends(max(groups, key=_revolutions)))) < FAST:
        return _slow(bare, run, motion, groups)
    window = measured_window(run, motion)
    settled = part(motion, window.lo, window.hi)
    if not (groups := _groups(settled)):
        return bare
    fast = measure(run, settled, max(groups, key=_revolutions), slow=False)
    shaft = shaft_of(settled, settled.pick(run.column("tau_l")))
    return replace(bare, fast=fast, shaft=shaft, spectrum=spectrum_of(settled), torque=window.torque)


def _slow(bare: Reading, run: Tame, motion: Motion, groups: list[list[Stroke]]) -> Reading:
    """Every speed by itself; one at which the motor stuck or hunted says nothing of the gear."""
    reference = motion.pick(run.column("theta_ref"))
    rejected = []
    for group in list(groups):
        evenness = smoothness(motion, group, reference)
        if evenness is not None and not evenness.passed:
            rejected.append(sentence(evenness))
            groups.remove(group)
    found = [k for g in groups if (k := measure(run, motion, g, slow=True)) is not None and k.speed_rpm < FAST]
    most = max(groups, key=_revolutions, default=None)
    ways = () if most is None else ways_of(motion, most, motion.pick(run.column("tau_l")))
    return replace(bare, slow=tuple(found), ways=ways, rejected=tuple(rejected))


def _groups(motion: Motion) -> list[list[Stroke]]:
    """Strokes of one speed together, slowest first; those of too few revolutions left out."""
    strokes = find_strokes(motion)
    return [g for g in groups_by_speed(motion, strokes) if _revolutions(g) >= FEWEST] if strokes else []


def _ends(group: list[Stroke]) -> tuple[int, int]:
    longest = max(group, key=lambda s: s.revolutions)
    return int(longest.edges[0]), int(longest.edges[-1])


def _revolutions(group: list[Stroke]) -> int:
    return sum(s.revolutions for s in group)
