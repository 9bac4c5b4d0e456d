"""A spring that is not straight: its compliance near zero torque, under load, and where its torque swings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, Port, Signals, parameter

STEP: Final = 1e-4  # relative, of a shape parameter: a compliance is smooth in them but for a knee


@dataclass(frozen=True)
class Compliance:
    """Of the gear, rad/(N·m), and its gradient by all that is fitted, the shapes that are loose last, by their
    logarithms."""

    value: float
    by: Array

    @property
    def stiffness(self) -> float:
        """N·m/rad, NaN of what is no spring."""
        return 1.0 / self.value if self.value > 0 else np.nan

    def told(self, name: str, c: Array) -> Parameter:
        """Its stiffness with an interval; `c` (p, p) is the covariance of all that is fitted."""
        half = self.stiffness**2 * Z95 * float(np.sqrt(max(0.0, float(self.by @ c @ self.by))))
        return parameter(name, self.stiffness, half, "N·m/rad")


@dataclass(frozen=True)
class Curves:
    """What bends the spring beside the `fitted` compliance; `slopes` are the loose shapes, (term, which of its)."""

    s: Solution
    fitted: Compliance
    slopes: Sequence[tuple[int, int]]

    def are_there(self) -> bool:
        """Whether a law in the model bends it."""
        return any(_gives(term, 0.0).size for term in self.s.design.terms)

    def near_zero(self) -> Compliance:
        """Near zero torque, where a maker's K_1 is and the k_1 of a cubic spring."""
        return self._at(0.0)

    def under_load(self) -> Compliance:
        """At the largest torque there was."""
        pieces = [piece for run in self.s.design.eq.runs for piece in run.pieces if piece.t.size]
        return self._at(max(float(np.abs(piece.torque).max()) for piece in pieces))

    def swinging(self) -> Compliance:
        """Where the torque changes, which is where the damper beside the spring is seen: what laws in the spring change
        by with it, the mean by how fast it does."""
        value, by, eq = self.fitted.value, self.fitted.by.copy(), self.s.design.eq
        pieces = [piece for i, run in enumerate(eq.runs) if (i, "A") in eq.rows for piece in run.pieces]
        for i, term in enumerate(self.s.design.terms):
            if share := term.effect.drags(term.shape):
                place = self.s.design.place(i)
                slopes = share * _slopes(term, pieces)
                value += float(slopes @ self.s.x[place])
                by[place] += slopes
        return Compliance(value, by)

    def _at(self, torque: float) -> Compliance:
        value, by = self.fitted.value, self.fitted.by.copy()
        for i, term in enumerate(self.s.design.terms):
            place, gives = self.s.design.place(i), _gives(term, torque)
            if gives.size:
                value += float(gives @ self.s.x[place])
                by[place] += gives
                for at, (owner, j) in enumerate(self.slopes):
                    if owner == i:
                        ends = [_gives(_stretched(term, j, sign * STEP), torque) for sign in (1.0, -1.0)]
                        by[self.s.design.size + at] += (ends[0] - ends[1]) @ self.s.x[place] / (2 * STEP)
        return Compliance(value, by)


def _slopes(term: Term, pieces: Sequence[Signals]) -> Array:
    """By what each column of the wind-up changes with the torque (k,), in the mean over Ṫ²."""
    along, size = np.zeros(0), 0.0
    for piece in pieces:
        columns = term.effect.columns(piece, term.shape)[Port.WIND_UP]
        rate = np.nan_to_num(piece.torque_rate) * piece.dt
        more = rate[1:] @ np.diff(columns, axis=0)
        along, size = (along + more if along.size else more), size + float(rate[1:] @ rate[1:])
    return np.asarray(along / max(size, 1e-300))


def _gives(term: Term, torque: float) -> Array:
    return np.asarray(term.effect.gives(np.array([torque]), term.shape)[0])


def _stretched(term: Term, j: int, share: float) -> Term:
    shape = tuple(x * (1.0 + share) if at == j else x for at, x in enumerate(term.shape))
    return Term(term.effect, shape)
