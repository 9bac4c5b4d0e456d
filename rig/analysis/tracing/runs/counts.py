"""Where a motor encoder's count is all that is known of the angle: the motor rests, or sticks and jumps.

Rounding is noise that the low-pass takes away while the motor moves over many counts within it. While it rests, it is
an error of up to half a count that stays, up to 6 µrad at the output for 10 000 counts and a ratio of 50: several times
the floor, and at the same angles it is the same again. Fitted as it stands it looks like steps of an encoder, or like
an error once per line.
"""

from __future__ import annotations

import itertools
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Array

Rows = npt.NDArray[np.bool_]
FREE: Final = 0.01  # s, twice the low-pass's standard deviation
LOCKED: Final = 0.1  # s: slower than stick and slip, faster than what winds a gear up
FEW: Final = 2.0  # counts within twice that: too few for their rounding to average out


def resting(theta: Array, dt: float, counts_per_turn: float, span: float) -> Rows:
    """Rows (n,) within `span` s of which `theta` [rad] moves by less than FEW counts; none when these are not known."""
    half = max(1, round(span / dt))
    if counts_per_turn <= 0 or theta.size <= 2 * half:
        return np.zeros(theta.size, dtype=np.bool_)
    moved = np.abs(theta[2 * half :] - theta[: -2 * half])
    return np.pad(moved < FEW * 2 * np.pi / counts_per_turn, half, mode="edge")


def one_a_stay(rest: Rows, shortest: int) -> Rows:
    """One row of every stay of `rest` (n,), none of the jumps between two stays that take fewer than `shortest` rows.

    However long it lasts, a stay is a single reading of the angle.
    """
    out = ~rest
    edges = np.flatnonzero(np.diff(rest.astype(np.int8), prepend=~rest[:1], append=~rest[-1:]))
    for lo, hi in itertools.pairwise(edges):
        if rest[lo]:
            out[(lo + hi) // 2] = True
        elif hi - lo < shortest:
            out[lo:hi] = False
    return out
