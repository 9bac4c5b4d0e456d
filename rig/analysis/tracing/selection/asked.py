"""What a verdict is asked of."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.sizes import is_hardly_known, may_be_nothing
from rig.analysis.tracing.thresholds import ALONE, MISSING
from rig.model.effect import Array, Parameter
from rig.model.effects import LIBRARY


@dataclass(frozen=True)
class Asked:
    """The prepared campaign and its model, what is in it `ranked` by what it does, `scores` of what all runs share,
    held-out residuals without and with the model, floors of the fitted blocks, what the search found, and what the
    parameters of the effects are."""

    p: Prepared
    s: Solution
    ranked: Sequence[str]
    scores: Sequence[HeldOutScore]
    before: Mapping[Key, Array]
    after: Mapping[Key, Array]
    floors: Mapping[Key, float]
    found: Found
    words: Mapping[str, Sequence[Parameter]]

    @property
    def names(self) -> tuple[str, ...]:
        """Those that are effects of the library."""
        return tuple(name for name in self.ranked if name not in CONFOUNDERS)

    @cached_property
    def sized(self) -> tuple[str, ...]:
        """Those of them of which a size at least is not nothing. Of several in the place of one law that has no name
        none may be left out, and none be anything."""
        return tuple(name for name in self.names if not may_be_nothing(LIBRARY[name], self.words.get(name, ())))

    @cached_property
    def measured(self) -> tuple[str, ...]:
        """Those of these of which a size is known, which beside something unknown says more than that there is one."""
        of = {name: LIBRARY[name].sizes(self.words.get(name, ())) for name in self.sized}
        return tuple(name for name, sizes in of.items() if not sizes or not all(map(is_hardly_known, sizes)))

    @property
    def one(self) -> float:
        """RMS over floor that a single run may have left."""
        return MISSING if self.names else ALONE

    @cached_property
    def loud(self) -> bool:
        """Whether more is left on unseen runs than may be."""
        return self.p.held_out.loud(self.after, self.one, bool(self.names)) or self.p.own.line is not None

    @cached_property
    def plain(self) -> set[str]:
        """Names that are plain to see."""
        return {score.name for score in self.scores if score.plain}

    @property
    def worst(self) -> tuple[float, float]:
        """RMS over floor of the worst channel without and with the model."""
        return self.p.held_out.worst(self.before)[0], self.p.held_out.worst(self.after)[0]

    @property
    def has_repeats(self) -> bool:
        """Without them no floor is known so well that a rest may stand."""
        return bool(repeats(self.p.eq.runs, self.p.split.fitted))
