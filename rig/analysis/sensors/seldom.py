"""A torque sensor that speaks less often than the loop reads: how often, and what of the torque is not seen for it."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion, Source
from rig.core.channels import Flag
from rig.core.rows import stretches

OFTEN: Final = 0.5  # of the rows with a new reading: from there on a reading is held for a row now and then, no more
COUNTS: Final = 4.0  # of the sensor, from one reading to the next: a coarse one at rest goes on by one or two
ROWS: Final = 200_000  # from which its count is taken: a run may have a day of them
ROUNDED: Final = 1e-9  # of the largest reading: what the numbers' own rounding makes of two equal ones


def said_seldom(run: Source, motion: Motion) -> str:
    """A sentence on a shaft torque that most rows hold from a row before; "" where it is read often enough, or nothing
    tells."""
    flags, torque = run.column("flags"), run.column("tau_l")
    if torque is None:
        return ""
    if flags is None:
        return seldom_by_value(motion.t, motion.pick(torque))
    return _said(motion.t, sum(_fresh(flags[some]) for some in stretches(flags.size)), flags.size)


def seldom_by_value(t: Array | None, torque: Array | None) -> str:
    """The same, of readings (n,) in N·m at `t` s that nothing says the age of: one that says again what the one before
    it said, and then something that is many counts away, was held."""
    if torque is None or torque.size < 2:
        return ""
    steps = np.abs(np.diff(torque[:ROWS]))
    steps = steps[steps > 0.0]
    if steps.size == 0 or float(np.median(steps)) < COUNTS * _count(torque[:ROWS]):
        return ""
    parts = (torque[max(some.start - 1, 0) : some.stop] for some in stretches(torque.size))
    return _said(t, 1 + sum(_changes(part) for part in parts), torque.size)


def _changes(torque: Array) -> int:
    """How many of some rows say something else than the one before."""
    return int(np.count_nonzero(np.abs(np.diff(torque)) > 0.0))


def _said(t: Array | None, fresh: int, rows: int) -> str:
    if t is None or t.size < 2 or fresh > OFTEN * rows or not fresh:
        return ""
    duration = float(t[-1] - t[0])
    if duration <= 0.0:
        return ""
    rate = fresh / duration
    return (
        f"The shaft torque is new in {fresh} of {rows} rows, {rate:.3g} times a second, and held between them: "
        f"what is in it above {rate / 2:.3g} Hz is not seen."
    )


def _count(torque: Array) -> float:
    """Smallest distance between two values that were read, N·m: one count of a coarse sensor, next to nothing of a fine
    one; infinite where only one was."""
    values = np.unique(torque[np.isfinite(torque)])
    apart = np.diff(values)
    apart = apart[apart > ROUNDED * np.max(np.abs(values), initial=0.0)]
    return float(np.min(apart)) if apart.size else np.inf


def _fresh(flags: Array) -> int:
    """How many of some rows have a new reading of the shaft torque."""
    stale = np.nan_to_num(flags).astype(np.int64) & int(Flag.STALE_TAU)
    return int(np.count_nonzero(stale == 0))
