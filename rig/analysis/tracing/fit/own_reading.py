"""Laws that are a function of the very torque they correct: they must leave most of it, and of its changes.

Where a torque hardly changes, a gain that falls with it can be had so large that it takes the torque away, or its
changes with their noise, and all that the model had to explain of it: nothing is left then, and next to no floor.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Term
from rig.model.effect import Array, Port, Signals

# of the reading, and of what it changes by within a run, RMS: a scale may be off by so much, and a part that goes with
# the square or the cube of a torque changes two and three times as fast as it grows
TAKEN: Final = 0.3
READ_AT: Final = {"tau_m": Port.READS_TAU_M, "torque": Port.READS_TAU_L}


def leaves_most(eq: Equations, runs: Sequence[int], term: Term, coefficients: Array) -> bool:
    """Whether a term with those coefficients (k,) leaves most of the reading that it is a function of."""
    if not term.effect.of_reading:
        return True
    taken, whole = np.zeros(2), np.zeros(2)
    for piece in (piece for run in runs for piece in eq.runs[run].pieces):
        grams, squares = _sums(piece, term)
        taken += np.einsum("i,nij,j->n", coefficients, grams, coefficients)
        whole += squares
    return bool(np.all(taken <= TAKEN**2 * whole))


def _sums(piece: Signals, term: Term) -> tuple[Array, Array]:
    """Products of its columns with each other (2, k, k), and sums of squares of what is read (2,): as they are, and
    about their means."""

    def made() -> tuple[Array, Array]:
        z = term.effect.columns(piece, term.shape)[READ_AT[term.effect.of_reading]]
        y = np.nan_to_num(getattr(piece, term.effect.of_reading))
        apart, change = z - z.mean(0), y - y.mean()
        return np.stack([z.T @ z, apart.T @ apart]), np.array([y @ y, change @ change])

    return piece.once(f"{term.name} in its own reading", made)
