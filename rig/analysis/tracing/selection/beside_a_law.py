"""The verdict where a law without a name, which no other term is needed beside, is in the model."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.confounders import Confounder
from rig.analysis.tracing.selection.next_run import along
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.standing import standing
from rig.analysis.tracing.thresholds import AT_THE_FLOOR

# a torque along the output's turn in one way only, as of a cable that tightens, is half of it a weight and half of it
# friction along that turn; a reading that runs away below some speed, to another scale and back above that speed
OTHER_HALF: Final[Mapping[str, frozenset[str]]] = {
    "sector_drag": frozenset({"gravity_unbalance"}),
    "other_scale": frozenset({"missed_counts"}),
}


def confounded(confounder: Confounder, names: tuple[str, ...]) -> Conclusion:
    """A law that is no effect of the library is in the model, which has it by then: no other term is added. A name that
    is half of what the law is the other half of does not stand beside it."""
    names = tuple(name for name in names if name not in OTHER_HALF.get(confounder.effect.name, ()))
    verdict = Verdict(Status.UNKNOWN, names, (), confounder.coordinate, None, None, confounder.sentence)
    return Conclusion(verdict, None, (confounder.coordinate,), along(confounder.coordinate))


def beside_a_law(
    coordinate: str, names: Sequence[str], scores: Sequence[HeldOutScore], plain: Collection[str], own: Collection[str]
) -> tuple[str, ...]:
    """Names that stand beside a law without one: what such a law has wrong of its form is chased by names as well, so
    that those alone stand that are plain to see; and what runs have each of its `own`, where nothing is left that it
    might have taken on."""
    stand = standing(coordinate, names, scores, plain, told=False)
    return tuple(name for name in names if name in stand or name in own)


def larger_than(
    confounders: Sequence[Confounder], names: Sequence[str], scores: Sequence[HeldOutScore], plain: Collection[str]
) -> tuple[str, ...]:
    """Names that do more than laws without one which are below the floor in every run and not plain to see: such a law
    is a sensor's little drift, or what is left of an effect's form. No names where none of them is plain."""
    laws = [score for score in scores if score.name in {confounder.effect.name for confounder in confounders}]
    most = max((score.size for score in laws), default=np.inf)
    if most >= AT_THE_FLOOR or any(score.name in plain for score in laws):
        return ()
    larger = tuple(score.name for score in scores if score.name in names and score.size > most)
    return larger if any(name in plain for name in larger) else ()


def beside_little(confounder: Confounder, conclusion: Conclusion) -> Conclusion:
    """The conclusion, and that a law without a name is in the model as well."""
    said = f"{conclusion.verdict.sentence} Beside it, less than the floor in any run: {confounder.sentence}"
    return replace(conclusion, verdict=replace(conclusion.verdict, sentence=said))
