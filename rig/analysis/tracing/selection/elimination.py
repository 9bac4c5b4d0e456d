"""Backward elimination on the held-out runs: effects go, the least first, until all that stay may be named."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rig.analysis.tracing.fit.leaning import leaning
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.search import ROUNDS, as_fit, possible, reduced
from rig.analysis.tracing.floor.held_out import HeldOut, unseen
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.score import HeldOutScore, scores
from rig.analysis.tracing.thresholds import ASTRAY, HARMFUL, SHADOW
from rig.core.units import TURN
from rig.model.effect import Parameter, Reach


def backward_elimination(s: Solution, at: HeldOut) -> tuple[Solution, Design, list[HeldOutScore]]:
    """The model with the effects alone that may be named; the one that does least goes first, all are scored anew."""
    d = unseen(s, at)
    while True:
        scored = scores(s, d, at)
        failing = [x for x in scored if not (_may_stand(x, scored) and _can_be(s, x.name) and _comes_round(d, x))]
        if not failing:
            return s, d, scored
        # what spoils a channel spoils the others' sizes with it
        worst = min(failing, key=lambda score: (-max(score.harm, HARMFUL), min(score.share, 1.0) * score.size))
        gone = _impossible(s, worst.name) if _may_stand(worst, scored) and _comes_round(d, worst) else []
        gone = gone or [i for i, t in enumerate(d.terms) if t.name == worst.name]
        s, d = fit(reduced(s.design, gone)), reduced(d, gone)
        if (again := _put_right(s)) is not s:
            s, d = again, unseen(again, at)


def _may_stand(one: HeldOutScore, scored: Sequence[HeldOutScore]) -> bool:
    """Whether it is named, and in nobody's shadow. A law without a name that takes no look-alike's place has many
    columns, and no reason but the rest itself: it has to be plain to see, or repeats vouch for it."""
    sure = one.plain or one.as_repeats or one.name not in CONFOUNDERS or bool(CONFOUNDERS[one.name].mimics)
    return one.named and sure and not _in_the_shadow(one, scored)


def _in_the_shadow(one: HeldOutScore, scored: Sequence[HeldOutScore]) -> bool:
    """Whether an effect that is not fair stands beside one so much larger in the same channel that what is wrong with
    the large one's law is as much."""
    channels = {c for _, c in one.ground}
    larger = [x for x in scored if x.size > SHADOW * one.size and channels & {c for _, c in x.ground}]
    return bool(larger) and not one.fairly


def _comes_round(d: Design, one: HeldOutScore) -> bool:
    """Whether a wave of the motor's angle goes through one whole cycle in the runs it acts most in: over the few
    degrees that a locked motor turns it is any curve, and what a torque constant loses under load goes by its name."""
    orders = [term.shape[0] for term in d.terms if term.name == one.name and term.effect.comes_round]
    turned = [float(np.ptp(d.eq.rows[key].theta_m)) for key in one.ground]
    known = [angle / TURN for angle in turned if np.isfinite(angle)]
    return not orders or not known or max(orders) * max(known) >= 1.0


def _put_right(s: Solution) -> Solution:
    """With columns that lean on what the fit says now, where an eliminated effect had led them astray: beside a spring
    half as stiff as it is even a true effect has the wrong size."""
    for _ in range(ROUNDS):
        eq = leaning(s.design.eq, s, ASTRAY)
        if eq is s.design.eq:
            break
        s = fit(design(eq, s.design.terms, sorted({run for run, _ in s.design.y})))
    return s


def _can_be(s: Solution, name: str) -> bool:
    """Whether the terms of an effect have the signs and sizes such an effect can have, now that all are fitted; where
    they make one sum, whether that has."""
    d = s.design
    found = [(t, s.x[d.place(i)]) for i, t in enumerate(d.terms) if t.name == name]
    sums = [p.value for t, c in found for p in t.effect.parameters(as_fit(s, t, c)) if p.name in t.effect.adds]
    if len(found) > 1 and not found[0][0].effect.plausible_together([as_fit(s, t, c) for t, c in found]):
        return False
    return sum(sums) > 0 if len(found) > 1 and sums else all(possible(s, t, c) for t, c in found)


def _impossible(s: Solution, name: str) -> list[int]:
    """Those of several terms of an effect, not all of them, that cannot be by themselves: what a first law had wrong a
    second one may take away again, and the effect is what is left without the first."""
    d = s.design
    mine = [i for i, t in enumerate(d.terms) if t.name == name]
    wrong = [i for i in mine if not possible(s, d.terms[i], s.x[d.place(i)])]
    return wrong if len(wrong) < len(mine) else []


def unresolved(s: Solution, words: Mapping[str, Sequence[Parameter]], covered: Reach) -> list[str]:
    """Effects of whose law the data say nothing, in any term: the interval of the number that scales it (a Stribeck
    speed, a torque, a time) contains zero, or it is a resonance beyond all that was excited. What is left of them is a
    difference between some runs and others, which many laws make.
    """
    names = dict.fromkeys(term.name for term in s.design.terms)
    return [name for name in names if not _is_resolved(s, name, scales(s, name, words), covered)]


def unscaled(s: Solution, words: Mapping[str, Sequence[Parameter]]) -> list[str]:
    """Effects with a scale of which every term's may be zero, whatever else speaks for them: beside a rest that no
    name explains they may be a part of that rest, as a fall of friction at 0.7 ± 0.9 rad/s is of a sensor's play."""
    names = dict.fromkeys(term.name for term in s.design.terms)
    found = {name: scales(s, name, words) for name in names}
    return [name for name, all_of in found.items() if all_of and all(p.holds_zero for p in all_of)]


def run_to_the_end(s: Solution, covered: Reach) -> list[str]:
    """Effects with a term that the fit pushed to the end of its range: it fills in for a law that is not there."""
    return list(dict.fromkeys(t.name for t in s.design.terms if t.effect.beyond(t.shape, covered)))


def _is_resolved(s: Solution, name: str, found: Sequence[Parameter], covered: Reach) -> bool:
    """Whether one term of an effect at least has its scale, where it has one, and lies within what was excited."""
    terms = [term for term in s.design.terms if term.name == name]
    within = [not term.effect.beyond(term.shape, covered) for term in terms]
    scaled = [terms[0].effect.is_scaled(p, covered) for p in found]
    if len(scaled) == len(within):
        return any(a and b for a, b in zip(within, scaled, strict=True))
    return any(within) and (any(scaled) or not scaled)


def scales(s: Solution, name: str, words: Mapping[str, Sequence[Parameter]]) -> list[Parameter]:
    """The first shape parameter that is fitted, of every term of an effect: the second one's is numbered."""
    effect = next(term.effect for term in s.design.terms if term.name == name)
    first = [n for n, free in zip(effect.shape_names, effect.loose, strict=True) if free][:1]
    return [p for p in words.get(name, ()) for n in first if p.name == n or p.name.removeprefix(f"{n}_").isdigit()]
