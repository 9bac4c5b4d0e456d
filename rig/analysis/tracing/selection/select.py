"""What of the search's effects is selected on the held-out runs."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.covariance import covariance, scatter
from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.fit.leaning import carrying
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.search import Found, polished, reduced
from rig.analysis.tracing.floor.held_out import HeldOut, held_out_blocks, unseen
from rig.analysis.tracing.floor.noise import Measured, measure, quieter
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, with_confounders
from rig.analysis.tracing.selection.elimination import backward_elimination, run_to_the_end, unresolved
from rig.analysis.tracing.selection.instead_of import at_a_vibration, instead_of_the_gear
from rig.analysis.tracing.selection.needless import without_idle, without_insignificant, without_needless
from rig.analysis.tracing.selection.own_scores import own_scores
from rig.analysis.tracing.selection.plainer import plainer
from rig.analysis.tracing.selection.selected import Kept, Selected, in_words, is_loud, left_over
from rig.analysis.tracing.selection.two_for_one import two_for_one
from rig.analysis.tracing.selection.uneven_fall import uneven_fall
from rig.analysis.tracing.thresholds import EXPLAINED, MISSING, NAMED, WORSE
from rig.model.effect import Reach

MUCH: Final = 1.5  # times the floor beside effects, from which on the one without them is another
AS_SENSORS: Final = 1.2  # times their noise: what runs of four campaigns that turn left lay within 0.94 and 1.16 of it


def select(p: Prepared, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Effects are eliminated until all that are left may be named; their laws are fitted again beside each other."""
    solution, held, scores = backward_elimination(found.solution, p.held_out)
    if len(solution.design.terms) < len(found.solution.design.terms):
        p = _floored(p, solution, runs)
        solution, held, scores = backward_elimination(solution, p.held_out)
    fewer = len(solution.design.terms) < len(found.solution.design.terms)
    if fewer or found.rough or len(solution.design.terms) > 1:
        solution, held, scores = _polished(p, solution, (solution, held, scores), runs, covered)
    p, solution = _own_kept(p, solution)
    solution, held, scores = _stood_in_for(p, (solution, held, scores), runs, covered)
    if (other := plainer(solution, runs)) is not solution:
        solution, held, scores = backward_elimination(other, p.held_out)
    for instead in (two_for_one, uneven_fall):
        if (other := instead(solution, runs, covered)) is not solution:
            again = backward_elimination(other, p.held_out)
            all_of_it = {term.name for term in again[0].design.terms} == {term.name for term in other.design.terms}
            solution, held, scores = again if all_of_it else (solution, held, scores)
    told = solution.design.terms
    while vague := _not_told(p, solution, held, runs, covered):
        # one at a time: without it another one's law may be plain
        candidates = [score for score in scores if score.name in vague]
        least = min(candidates, key=lambda score: min(score.share, 1.0) * score.size).name
        gone = [i for i, term in enumerate(solution.design.terms) if term.name == least]
        solution, held, scores = backward_elimination(
            polished(fit(reduced(solution.design, gone)), runs, covered), p.held_out
        )
    if len(solution.design.terms) < len(told):
        p = _floored(p, solution, runs)
        solution, held, scores = backward_elimination(solution, p.held_out)
    if not solution.design.terms and solution.design.eq is not p.eq:
        # what eliminated effects made of the gear, and with it of readings it stands in for, goes with them
        solution = fit(design(carrying(p.eq, ()), (), runs))
        held = unseen(solution, p.held_out)
    selected = Selected(p, solution, held, scores, in_words(solution, runs, covariance))
    selected = without_needless(without_insignificant(selected, runs, covered), runs, covered)
    return without_idle(selected, runs, covered)


def _not_told(p: Prepared, s: Solution, held: Design, runs: Sequence[int], covered: Reach) -> list[str]:
    """Effects of whose law, or of which beside the spring, the data say nothing; beside an unknown rest those too that
    a law at the end of its range was needed for."""
    words = in_words(s, runs, scatter)
    vague = unresolved(s, words, covered) or instead_of_the_gear(s) or at_a_vibration(p.own, words)
    ended = run_to_the_end(s, covered)
    return vague or (ended if ended and is_loud(p.held_out, s, held) else [])


def _polished(p: Prepared, s: Solution, so_far: Kept, runs: Sequence[int], covered: Reach) -> Kept:
    """Laws fitted again beside those that stayed; as they were where that loses one, or leaves much more of unseen
    runs: two terms of one effect can trade what single runs show, and foretell nonsense of others."""
    again = backward_elimination(polished(s, runs, covered), p.held_out)
    kept = {term.name for term in again[0].design.terms}
    now, before = (left_over(p, one) for one in (again, so_far))
    worse = now > max(WORSE * before, EXPLAINED)
    return again if kept >= {term.name for term in s.design.terms} and not worse else so_far


def _stood_in_for(p: Prepared, kept: Kept, runs: Sequence[int], covered: Reach) -> Kept:
    """With the confounders that explain more than what they are taken for. What leaves more of unseen runs takes no
    name away: fitted ones may tell two loops apart by what either law has wrong (exam 34, case 25). Where one may fall
    short of its look-alike and does by no more, and that one leaves much itself, either may be what there is: no name
    then (exam 56, case 42)."""
    s, other = kept[0], with_confounders(kept[0], runs, covered)
    again = backward_elimination(other, p.held_out)
    came = {term.name for term in other.design.terms} - {term.name for term in s.design.terms}
    if not came:
        return again
    as_it_was = backward_elimination(s, p.held_out)
    if came.isdisjoint(term.name for term in again[0].design.terms):
        return as_it_was
    freed = {law.zero_of for name, law in CONFOUNDERS.items() if name in came}
    if _left_where_it_slides(p, again, freed) < _left_where_it_slides(p, as_it_was, freed):
        return again
    short = [law for name, law in CONFOUNDERS.items() if name in came and law.short]
    mimicked = frozenset().union(*(law.mimics for law in short))
    amiss = any(score.name in mimicked and score.left > MISSING for score in as_it_was[2])
    return again if amiss and len(short) == len(came) else as_it_was


def _left_where_it_slides(p: Prepared, kept: Kept, freed: Collection[str]) -> float:
    """RMS over floor of the worst channel on unseen runs, but at reversals, where friction that builds up leaves most
    of it whatever it stands beside, and but those of which a law has `freed` every run's zero: it leaves less there,
    true or not."""
    left = p.held_out.residuals(kept[0], kept[1])
    return p.held_out.worst({key: e for key, e in left.items() if key[1] not in {"R", *freed}} or left)[0]


def _floored(p: Prepared, s: Solution, runs: Sequence[int]) -> Prepared:
    """With the floor measured beside the effects that stayed: eliminated ones may have taken noise with them.

    Where nothing was repeated one turn differs from the next by what the model lacks as well: the floor beside effects
    stays, unless nothing is left over the larger one either and it is not what the sensors make; or it is far less.
    """
    measured = quieter(p.first, measure(s, runs)) if s.design.terms else p.first
    if any(term.effect.remembers for term in s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(p, measured=measured, held_out=_held_out(p, p.eq, measured))
    if repeats(p.eq.runs, runs) or _took_noise(p, measured):
        return again
    quiet = not is_loud(again.held_out, s, unseen(s, again.held_out))
    return again if quiet and not _is_the_sensors(p, measured) else p


def _took_noise(p: Prepared, measured: Measured) -> bool:
    """Whether the floor beside effects is much lower in a channel than what was `measured` without, and than the noise
    of the sensors: an inertia of its own that is damped away leaves the gear less, and less of the noise."""
    return any(
        measured.noise.sigma[c] > MUCH * p.measured.noise.sigma[c]
        and MUCH * p.measured.noise.sigma[c] < _of_sensors(p.first, c)
        for c in WHOLE
    )


def _is_the_sensors(p: Prepared, measured: Measured) -> bool:
    """Whether the floor beside effects, where it is much lower than what was `measured` without, is what the noise of
    the sensors makes: it took no noise with it, and what turns differ by is missing."""
    lower = [c for c in WHOLE if measured.noise.sigma[c] > MUCH * p.measured.noise.sigma[c]]
    return bool(lower) and all(p.measured.noise.sigma[c] < AS_SENSORS * _of_sensors(p.first, c) for c in lower)


def _of_sensors(measured: Measured, channel: str) -> float:
    """RMS of their noise in a channel, 0 where none is known."""
    white = [rms for (_, c), rms in measured.white.items() if c == channel]
    return float(np.sqrt(np.mean(np.square(white)))) if white else 0.0


def _held_out(p: Prepared, eq: Equations, measured: Measured) -> HeldOut:
    """Those blocks anew, of a campaign that is as calm as it was."""
    return replace(held_out_blocks(eq, measured, p.split.held_out), calm=p.held_out.calm)


def _own_kept(p: Prepared, s: Solution) -> tuple[Prepared, Solution]:
    """Without effects of each run's own that take too little of the held-out excess to be named."""
    failing = [name for name, (share, _) in own_scores(p, s).items() if share < NAMED]
    if not failing:
        return p, s
    left = p.own.without(failing)
    again = replace(p, own=left, eq=replace(p.eq, own=left.columns()))
    eq = replace(s.design.eq, own=left.columns())
    again = replace(again, held_out=_held_out(p, again.eq, again.measured))
    return again, fit(design(eq, s.design.terms, p.split.fitted))
