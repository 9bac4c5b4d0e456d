"""What a run's file says, row by row: its columns and their times, and where rows follow each other without a gap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.motion.source import Motion, Source, motion_of
from rig.analysis.sensors.seldom import said_seldom, seldom_by_value
from rig.analysis.tracing.runs.clocked import is_clocked
from rig.analysis.tracing.runs.grid import grid, joined, refuse_other_time, refuse_sparse
from rig.analysis.tracing.runs.holes import without_holes
from rig.analysis.tracing.runs.stamped import evened
from rig.model.effect import Array


@dataclass(frozen=True)
class AsRead:
    """The rows of one run."""

    t: Array  # s, (n,)
    dt: float  # s between rows
    columns: dict[str, Array | None]  # theta_m, theta_l, tau_m, tau_l, temperature, (n,) or not measured
    has: frozenset[str]  # of these and t
    unbroken: tuple[tuple[int, int], ...]  # rows lo..hi that follow each other
    clocked: bool  # its seconds are those of the speed that it and others declare
    notes: tuple[str, ...]

    def filled(self) -> dict[str, Array]:
        """The columns, NaN what was not measured."""
        return {name: np.full(self.t.size, np.nan) if x is None else x for name, x in self.columns.items()}


def as_read(run: Source, in_file: int, hz: float | None) -> AsRead:
    """The columns the tracer uses, of a file of so many rows. Those of a run without a time that declares its speed
    come `hz` times a second, where that is known. Raises UsageError when the run has no angle it can use, a time in
    another unit, or rows too far apart or too close."""
    motion = motion_of(run)
    refuse_other_time(run.column("t"), motion)
    columns, breaks, holes = without_holes(_columns(run, motion), motion.breaks if motion else ())
    rows = next((x.size for x in columns.values() if x is not None), in_file)
    clocked = hz is not None and is_clocked(run)
    if hz is not None and clocked:
        columns["t"] = np.arange(rows) / hz
    has = frozenset(name for name, x in columns.items() if x is not None)
    t, dt, timed = grid(columns.pop("t"), rows, run)
    refuse_sparse(rows, dt)
    theta_m, theta_l = columns["theta_m"], columns["theta_l"]
    t, jitter = evened(t, theta_l if theta_m is None else theta_m, dt)
    dt = float(np.median(np.diff(t))) if jitter else dt
    unbroken = joined(t, np.full(rows, np.nan) if theta_m is None else theta_m, dt, breaks, timed)
    held = said_seldom(run, motion) if motion else seldom_by_value(t, columns["tau_l"])
    notes = (*(motion.notes if motion else ()), *filter(None, (holes, jitter, held)))
    return AsRead(t, dt, columns, has, tuple(unbroken), clocked, notes)


def _columns(run: Source, motion: Motion | None) -> dict[str, Array | None]:
    names = ("tau_m", "tau_l", "temperature")
    if motion is None:
        found = {name: _there(run.column(name)) for name in (*names, "theta_l")}
        return {"t": run.column("t"), "theta_m": None, **found}
    picked = {name: _there(motion.pick(run.column(name))) for name in names}
    return {"t": motion.t, "theta_m": motion.theta_m, "theta_l": motion.theta_l, **picked}


def _there(x: Array | None) -> Array | None:
    """A column of which most is numbers; one of mostly holes is no measurement."""
    return x if x is not None and float(np.mean(np.isfinite(x))) > 0.5 else None
