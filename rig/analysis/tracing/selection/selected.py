"""What is selected of a search's effects: the model with them, on the held-out runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.fit.parameters import effects
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.levels import friction_by_speed, of_turning
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.thresholds import MISSING
from rig.model.effect import Array, Parameter

Words = dict[str, tuple[Parameter, ...]]
"""Parameters by effect."""

Kept = tuple[Solution, Design, list[HeldOutScore]]
"""As `backward_elimination` gives it."""


@dataclass(frozen=True)
class Selected:
    """The model with the effects that may be named, on the held-out runs, and their parameters in words."""

    p: Prepared
    solution: Solution
    held: Design
    scores: list[HeldOutScore]
    words: Words

    @property
    def names(self) -> set[str]:
        """Effects that stand."""
        return {term.name for term in self.solution.design.terms}

    @property
    def taken(self) -> frozenset[str]:
        """Names that are not looked for beside what is there: those of effects that every run has to itself."""
        return frozenset(self.p.own.made)

    @property
    def fitted_runs(self) -> list[Recording]:
        """Those the fit has seen."""
        return [self.p.eq.runs[i] for i in self.p.split.fitted]

    @property
    def left(self) -> float:
        """RMS over floor of the worst channel on unseen runs."""
        return left_over(self.p, (self.solution, self.held, self.scores))

    @cached_property
    def loud(self) -> bool:
        """Whether more is left on the held-out runs than may be, or the same in all runs at one speed."""
        return is_loud(self.p.held_out, self.solution, self.held) or by_speed(self.p, self.solution, self.held)


def is_loud(at: HeldOut, s: Solution, held: Design) -> bool:
    """Whether more is left on the held-out runs than may be."""
    return at.loud(at.residuals(s, held), MISSING, bool(s.design.terms))


def by_speed(p: Prepared, s: Solution, held: Design) -> bool:
    left = {key: s.residual(key) for key in s.keys} | p.held_out.residuals(s, held)
    return friction_by_speed(of_turning(p.eq, left, {**p.floors, **p.held_out.floors})) is not None


def left_over(p: Prepared, kept: Kept) -> float:
    """RMS over floor of the worst channel on unseen runs."""
    return p.held_out.worst(p.held_out.residuals(kept[0], kept[1]))[0]


def in_words(s: Solution, runs: Sequence[int], spread: Callable[[Solution], Array]) -> Words:
    return effects(s, runs, spread) if s.design.terms else {}
