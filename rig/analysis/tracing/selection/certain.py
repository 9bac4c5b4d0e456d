"""Whether what is found where nothing is above the floor may be said all the same."""

from __future__ import annotations

from collections.abc import Mapping

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.floor.held_out import HeldOut, unseen
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, confounders_in
from rig.analysis.tracing.selection.elimination import scales
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.selected import Selected, by_speed, is_loud
from rig.analysis.tracing.selection.sizes import is_hardly_known
from rig.analysis.tracing.selection.zeros_foretold import are_foretold
from rig.analysis.tracing.thresholds import ALL, LESS, MISSING, PLAIN_TO_SEE, QUIET, SEEN, VOUCHED_FOR
from rig.model.effect import Array


def is_certain(selected: Selected, floors: HeldOut) -> bool:
    """Whether effects may be named though the baseline alone is at the `floors`: measured on few repeats, those can be
    too high. Every name must (a) be large with a known size, or be confirmed by repeats; (b) have one size in all runs;
    (c) explain the channels it acts on; (d) need nothing unnamed beside it. (c) and (d) go by the `floors` given, for
    beside those measured with the effect in the model small effects of others may stand out. Of an effect that shows
    in the means of runs alone it is enough that it foretells the means of unseen runs."""
    loud = all(is_loud(at, selected.solution, selected.held) for at in (selected.p.held_out, floors))
    plain = selected.scores and not confounders_in(selected.solution) and not loud
    to_see = bool(plain) and all(_is_plain_to_see(selected, score) for score in selected.scores)
    to_see = to_see or (not loud and stands_in_means(selected))
    return to_see and (len(selected.scores) == 1 or _foretell(selected))


def stands_in_means(selected: Selected) -> bool:
    """Whether all that is selected is one effect, or one law without a name, and foretells the means of unseen runs."""
    return len(selected.scores) == 1 and are_foretold(selected.p, selected)


def _foretell(selected: Selected) -> bool:
    """Whether all of them together leave less of unseen runs where they act than the baseline alone: a gap and a spring
    that is stiffer about zero each take away what the other one makes, and nothing else."""
    p, acts = selected.p, sorted({key for score in selected.scores for key in score.ground})
    before = p.held_out.residuals(p.baseline, unseen(p.baseline, p.held_out))
    after = p.held_out.residuals(selected.solution, selected.held)
    return not acts or p.held_out.ratio(after, acts) < LESS * p.held_out.ratio(before, acts)


def _is_plain_to_see(selected: Selected, score: HeldOutScore) -> bool:
    """Large, and of a size that is known, or foretold of unseen runs where its law is: two runs at one speed may be all
    that show a resonance, and from two no interval comes out narrow."""
    effect = next(term.effect for term in selected.solution.design.terms if term.name == score.name)
    law = scales(selected.solution, score.name, selected.words)
    foretold = score.share > ALL and bool(law) and not any(is_hardly_known(scale) for scale in law)
    known = foretold or not all(is_hardly_known(size) for size in effect.sizes(selected.words.get(score.name, ())))
    vouched = score.as_repeats and (score.size > VOUCHED_FOR or score.seen > SEEN)
    return score.fairly and ((known and score.size > PLAIN_TO_SEE) or vouched)


def is_calm(p: Prepared) -> bool:
    """Whether the baseline is at the floor on the held-out runs, and no speed has a friction of its own."""
    held = unseen(p.baseline, p.held_out)
    return _is_at_the_floor(p, p.held_out.residuals(p.baseline, held)) and not by_speed(p, p.baseline, held)


def is_calm_there(p: Prepared, selected: Selected) -> bool:
    """Whether all that is selected are laws without a name, and the baseline is at the floor in every channel they act
    in, its means as well: what another channel has beyond its floor is no reason for them."""
    channels = {c for score in selected.scores for _, c in score.ground}
    if not channels or not selected.names <= CONFOUNDERS.keys() or stands_in_means(selected):
        return False
    left = p.held_out.residuals(p.baseline, unseen(p.baseline, p.held_out))
    return _is_at_the_floor(p, {key: e for key, e in left.items() if key[1] in channels})


def _is_at_the_floor(p: Prepared, left: Mapping[Key, Array]) -> bool:
    most, one = p.held_out.beyond_chance(left)
    return most < QUIET and one < MISSING
