"""What a locked run did before it first turned back.

Where a loop begins depends on what was done to the gear before the run, which no run tells: a lock check that wound it
up and let it go leaves it on one branch, a gear that was never wound up starts between the two. From the first
reversal on both are the same. Fitted as a start from nothing, the first stroke of a short lock test spoils the loop.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Signals

TURNED: Final = 0.2  # of the range: so far back is a reversal, no step of a motor that sticks and slips
FROM_THE_MIDDLE: Final = 0.75  # of the range: a first stroke that is longer began at a reversal itself


def has_turned(piece: Signals, run: Recording) -> npt.NDArray[np.bool_]:
    """Rows (n,) from the first reversal on; all, where the run began at one or never turned back."""
    if piece.cut is None:
        return np.arange(piece.t.size) >= first_reversal(run.wound(piece))
    return np.asarray(piece.cut.rows) >= first_reversal(run.wound(piece.cut.whole))


def first_reversal(theta: Array) -> int:
    """Row of the first extreme of an angle (n,) that sets out from the middle of its range; 0 when it has none."""
    far = TURNED * float(np.ptp(theta))
    out = np.flatnonzero(np.abs(theta - theta[0]) > far)
    if far <= 0.0 or not out.size:
        return 0
    way = np.sign(theta[out[0]] - theta[0])
    reached = np.maximum.accumulate(way * theta)
    back = np.flatnonzero(reached - way * theta > far)
    if not back.size:
        return 0
    top = int(np.argmax(way * theta[: back[0]]))
    return top if abs(theta[top] - theta[0]) < FROM_THE_MIDDLE * np.ptp(theta) else 0
