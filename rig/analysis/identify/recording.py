"""What identification reads of one run, and the stretches of it in which the motor kept one speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.kinematic_error.ratio import doubt
from rig.analysis.motion.angle import is_another_ratio, measured_ratio
from rig.analysis.motion.declared import declared
from rig.analysis.motion.mistaken import mistaken
from rig.analysis.motion.source import Motion, Source, motion_of
from rig.core.errors import DataError
from rig.core.numbers import number
from rig.core.units import TURN

BLOCK = 0.1  # s over which a speed is taken to find plateaus: 160 counts at 9.6 rpm with 10 000 counts a turn
STEADY = 0.06  # of the speed: how far a block may lie from the plateau's own median; 500 rpm swings by 1 %
STEADY_LEAST = 0.25  # rad/s allowed at any speed: stick-slip of the slow loop is not a change of speed
TRIM = 3  # blocks left out at either end of a plateau: the corner of a ramp
SHORTEST = 1.0  # s
SLOWEST = 0.25  # rad/s, 2.4 rpm: below, the motor may be sticking


@dataclass(frozen=True)
class Recording:
    """One run; arrays (n,), SI, None where not recorded. `tau_ext` as the manifest says it."""

    name: str
    procedure: str
    ratio: float
    motion: Motion
    t: Array
    tau_m: Array | None
    tau_l: Array | None
    tau_ext: float
    locked: bool
    source: Source

    @property
    def theta_m(self) -> Array:
        """rad"""
        return self.motion.theta_m

    @property
    def theta_l(self) -> Array:
        """rad"""
        assert self.motion.theta_l is not None
        return self.motion.theta_l

    @cached_property
    def followed(self) -> npt.NDArray[np.bool_]:
        """(n,) rows in which a loop followed a reference; nowhere where the run does not say."""
        reference = self.motion.pick(self.source.column("theta_ref"))
        return np.zeros(self.t.size, dtype=bool) if reference is None else np.isfinite(reference)

    @property
    def count_m(self) -> float:
        """rad of one count of the motor's encoder; 0 where the run does not say."""
        counts = declared(self.source.manifest.get("encoders") or {}, "motor_counts_per_rev")
        return TURN / counts if counts else 0.0

    def with_load_late_by(self, delay: float) -> Recording:
        """The run with the load angle `delay` s earlier than it was read; a cubic spline between rows."""
        from scipy.interpolate import CubicSpline  # half of what an analysis waits for, and few need it

        moved = CubicSpline(self.t, self.theta_l)(np.clip(self.t + delay, self.t[0], self.t[-1]))
        return replace(self, motion=replace(self.motion, theta_l=np.asarray(moved)))


@dataclass(frozen=True)
class Plateau:
    """Rows lo..hi of a run at one speed, at least one turn; `way` ±1."""

    run: Recording
    lo: int
    hi: int
    omega: float  # rad/s of the motor, mean, signed

    @property
    def way(self) -> float:
        """±1"""
        return float(np.sign(self.omega))

    @property
    def followed(self) -> bool:
        """Whether a loop followed a reference here; False where the run does not say."""
        return bool(self.run.followed[self.lo : self.hi].any())

    @property
    def duration(self) -> float:
        """s"""
        return float(self.run.t[self.hi - 1] - self.run.t[self.lo])


def recording(source: Source) -> Recording | None:
    """The run as identification needs it; None when it lacks time or one of the angles."""
    motion = motion_of(source)
    if motion is None or motion.theta_l is None or motion.t is None or motion.theta_m.size < 200:
        return None
    conditions = source.conditions
    return Recording(
        name=source.name,
        procedure=source.procedure,
        ratio=motion.ratio,
        motion=motion,
        t=motion.t,
        tau_m=_torque(motion, source, "tau_m"),
        tau_l=_torque(motion, source, "tau_l"),
        tau_ext=number(conditions.get("tau_ext"), 0.0),
        locked=bool(conditions.get("output_locked")),
        source=source,
    )


def refuse_another_ratio(runs: Sequence[Recording]) -> None:
    """Raises DataError when most of `runs` that turn show another ratio than the one declared."""
    free = [run for run in runs if not run.locked and np.ptp(run.theta_m) > 0]
    odd = [(run.name, why) for run in free if (why := _another_ratio(run))]
    if 2 * len(odd) > len(free):
        first, why = odd[0]
        raise DataError(f"in {len(odd)} of {len(free)} runs that turn (here {first}): {why}")


def _another_ratio(run: Recording) -> str:
    measured = measured_ratio(run.theta_m, run.theta_l)
    if is_another_ratio(run.ratio / measured, float(np.ptp(run.theta_m)) / run.ratio):
        return (
            f"the motor goes {measured:.4g} times as far as the load, the declared gear.ratio is {run.ratio:g}: "
            f"{mistaken(run.ratio, measured) or 'another gear, or an angle in another unit than rad'}"
        )
    K = declared(run.source.declared, "K")
    return doubt(run.motion, run.tau_l, K) if run.tau_l is not None and K is not None else ""


def _torque(motion: Motion, source: Source, name: str) -> Array | None:
    column = motion.pick(source.column(name))
    return column if column is not None and bool(np.isfinite(column).all()) else None


def plateaus(run: Recording) -> list[Plateau]:
    """The stretches at one speed, in time order: within a few per cent of their own median, whole turns only."""
    period = float(np.median(np.diff(run.t)))
    size = max(round(BLOCK / period), 2)
    edges = np.arange(0, run.t.size, size)
    if edges.size < 8 or run.locked:
        return []
    omega = np.diff(run.theta_m[edges]) / np.diff(run.t[edges])
    found = [_plateau(run, edges, a, b) for a, b in _pieces(omega, run.followed[edges])]
    return [p for p in found if p is not None]


def _pieces(omega: Array, followed: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Index ranges of `omega` near their own running median, of one sign, all with or all without a loop."""
    pieces, begin = [], 0
    for i in range(1, omega.size + 1):
        usual = float(np.median(omega[max(begin, i - 40) : i]))  # the last 4 s: a slow drift is no new plateau
        near = i < omega.size and abs(omega[i] - usual) <= max(STEADY * abs(usual), STEADY_LEAST)
        if near and omega[i] * usual > 0 and followed[i] == followed[begin]:
            continue
        pieces.append((begin, i))
        begin = i
    return pieces


def _plateau(run: Recording, edges: np.ndarray[Any, Any], a: int, b: int) -> Plateau | None:
    a, b = a + TRIM, b - TRIM
    if b - a < 4:
        return None
    lo, hi = int(edges[a]), int(edges[b])
    theta, way = run.theta_m, np.sign(run.theta_m[hi] - run.theta_m[lo])
    turns = int(abs(theta[hi] - theta[lo]) / TURN)
    if turns < 1:
        return None
    progress = np.maximum.accumulate(way * (theta[lo : hi + 1] - theta[lo]))
    hi = lo + int(np.searchsorted(progress, turns * TURN))
    duration = float(run.t[hi] - run.t[lo])
    omega = float(theta[hi] - theta[lo]) / duration
    return Plateau(run, lo, hi, omega) if duration >= SHORTEST and abs(omega) >= SLOWEST else None
