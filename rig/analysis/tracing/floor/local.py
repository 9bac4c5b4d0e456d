"""Effects every run has in its own way: a vibration of unknown phase, steps where an encoder lost counts.

They are found in the fitted runs; where they are, each run, held out or not, is given its own phase or its own steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.model.effect import Array


def clock(eq: Equations, key: Key) -> Array:
    """Time of each row, s."""
    return at_rows(eq, key, "t")


def at_rows(eq: Equations, key: Key, name: str) -> Array:
    """What the signals of a run have by that name, at each row of a block, (n,)."""
    run = eq.runs[key[0]]
    whole = [getattr(piece, name)[run.smoother.centres(piece.t.size)] for piece in run.pieces]
    return np.asarray(np.concatenate(whole)[eq.rows[key].keep])


def joined(made: Sequence[Mapping[Key, Array]]) -> dict[Key, Array]:
    """Columns of all kinds side by side, (n, q)."""
    return {key: np.hstack([m[key] for m in made if key in m]) for key in {k for m in made for k in m}}
