"""A torque sensor that speaks less often than the loop reads: how often, and what of the torque is not seen for it."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion, Source
from rig.core.channels import Flag
from rig.core.rows import stretches

OFTEN = 0.5  # of the rows with a new reading: from there on a reading is held for a row now and then, no more


def said_seldom(run: Source, motion: Motion) -> str:
    """A sentence on a shaft torque that most rows hold from a row before; "" where it is read often enough, or nothing
    tells."""
    flags, t = run.column("flags"), motion.t
    if flags is None or t is None or t.size < 2 or run.column("tau_l") is None:
        return ""
    fresh = sum(_fresh(flags[some]) for some in stretches(flags.size))
    duration = float(t[-1] - t[0])
    if fresh > OFTEN * flags.size or not fresh or duration <= 0.0:
        return ""
    rate = fresh / duration
    return (
        f"The shaft torque is new in {fresh} of {flags.size} rows, {rate:.3g} times a second, and held between them: "
        f"what is in it above {rate / 2:.3g} Hz is not seen."
    )


def _fresh(flags: Array) -> int:
    """How many of some rows have a new reading of the shaft torque."""
    stale = np.nan_to_num(flags).astype(np.int64) & int(Flag.STALE_TAU)
    return int(np.count_nonzero(stale == 0))
