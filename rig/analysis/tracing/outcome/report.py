"""From the fit to what is said: verdict, floors, errors before and after."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit import parameters
from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution
from rig.analysis.tracing.fit.search import Found as Searched
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.outcome.beyond import beyond, undecided
from rig.analysis.tracing.outcome.curves import curves
from rig.analysis.tracing.outcome.dismissed import dismissed
from rig.analysis.tracing.outcome.each_run import beside_the_numbers
from rig.analysis.tracing.outcome.errors import errors
from rig.analysis.tracing.outcome.free import Free, curves_of, free, with_free
from rig.analysis.tracing.outcome.honest import honest, not_told
from rig.analysis.tracing.outcome.laws import laws_in
from rig.analysis.tracing.outcome.mean_drift import MeanDrift, mean_drifts
from rig.analysis.tracing.outcome.pictures import pictures
from rig.analysis.tracing.outcome.result import Floor, Found, Trace
from rig.analysis.tracing.outcome.ripple import Ripple, ripples
from rig.analysis.tracing.outcome.unlike import unlike_declared
from rig.analysis.tracing.outcome.unnamed import Unnamed, unnamed
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.lives import lives_in
from rig.analysis.tracing.runs.cannot import cannot, together
from rig.analysis.tracing.selection.asked import Asked
from rig.analysis.tracing.selection.candidates import candidates
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.confounders import confounders_in
from rig.analysis.tracing.selection.one_sided import COGGING, one_sided
from rig.analysis.tracing.selection.own_scores import own_scores
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.analysis.tracing.selection.verdict import decide
from rig.model.effect import Array, Parameter
from rig.process.workers import meanwhile


def report(
    p: Prepared,
    found: Searched,
    s: Solution,
    held: Design,
    scores: Sequence[HeldOutScore],
    fitted: Mapping[str, tuple[Parameter, ...]],
) -> Trace:
    """All of it as one value; `fitted` are the parameters of the effects in `s`."""
    empty, fitted_runs = p.baseline, [p.eq.runs[i] for i in p.split.fitted]
    before, after = p.held_out.residuals(empty, unseen(empty, p.held_out)), p.held_out.residuals(s, held)
    shares, ranked = _ranked(p, s, scores)
    one_way = one_sided(fitted)
    ranked = tuple(name for name in ranked if not (one_way and name == COGGING))
    baseline = honest(parameters.inertias_by_what_returns(empty, p.split.fitted), fitted_runs)
    conclusion = decide(Asked(p, s, ranked, scores, before, after, p.floors, found, fitted))
    conclusion, decided = undecided(p, conclusion, after, beyond(p, baseline))
    beside = _beside(p, s, after, conclusion)
    final = beside.after
    confounded = frozenset(name for confounder in confounders_in(s) for name in confounder.mimics)
    words, first = p.own.parameters | dict(fitted), errors(p.eq, p.held_out, before)
    with meanwhile(lambda: _shown(p, empty, s, before, final)) as shown:
        lives = conclusion.lives_in or (lives_in(p.eq, _left(empty), p.floors) if shares else ())
        tried = candidates(p, found.ranking, before, conclusion.verdict.effects, confounded)
        tried = dismissed(tried, conclusion.verdict, first.pooled)
        refitted = honest(parameters.inertias_by_what_returns(s, p.split.fitted), fitted_runs)
        ripple = ripples(p.campaign.runs)
        drift = mean_drifts(p.campaign.runs)
        simulated, drawn = shown()
    named = [name for name in conclusion.verdict.effects if name in shares]
    effects = tuple(Found(name, words.get(name, ()), shares[name], name in p.own.made) for name in named)
    return Trace(
        campaign=p.campaign.name,
        simulated=p.campaign.simulated,
        fitted=tuple(p.eq.runs[i].name for i in p.split.fitted),
        held_out=tuple(p.eq.runs[i].name for i in p.split.held_out),
        held_out_how=p.split.how,
        floors=_floors(p),
        baseline=baseline,
        baseline_after=refitted,
        cannot_be_told_apart=together(p.campaign.runs),
        unexplained=unexplained(p, before),
        ratios_before=ratios(p, before),
        ratios_after=ratios(p, final),
        ratios_named=ratios(p, after),
        lives_in=lives,
        candidates=tried,
        verdict=conclusion.verdict,
        effects=effects,
        before=with_free(first, simulated, 0),
        after=with_free(errors(p.eq, p.held_out, final), simulated, 1),
        next_run=conclusion.next_run,
        notes=(*unlike_declared(refitted, fitted_runs), *_notes(p, effects, one_way, ripple, drift)),
        ripple=ripple,
        mean_drift=drift,
        added_curves=beside.curves,
        law=laws_in(s) if beside.curves or conclusion.home is None else (),
        read=len(p.campaign.runs),
        left_out=p.campaign.left_out,
        cannot=(
            *conclusion.cannot,
            *not_told(refitted, fitted_runs),
            *p.measured.never_compared(),
            *cannot(p.campaign.runs),
        ),
        curves={name: x for name, x in drawn.items() if decided or not name.startswith("share")},
    )


def _beside(p: Prepared, s: Solution, after: dict[Key, Array], conclusion: Conclusion) -> Unnamed:
    """What has no name, where something is left that lives somewhere."""
    lives = conclusion.home is not None or conclusion.verdict.status == Status.UNKNOWN
    return unnamed(p, s, after, conclusion.home, conclusion.verdict.coordinate) if lives else Unnamed(after)


def _notes(
    p: Prepared, effects: Sequence[Found], one_way: str, ripple: Sequence[Ripple], drift: Sequence[MeanDrift]
) -> list[str]:
    """What goes with the effects that are named, with torques by order and by day, and with the campaign."""
    mine = [p.own.notes[found.effect] for found in effects if found.effect in p.own.notes]
    torques = [*(r.sentence() for r in ripple), *(mean.sentence() for mean in drift)]
    told = [*beside_the_numbers(effects), *mine, *([one_way] if one_way else []), *torques, *p.campaign.notes]
    return list(dict.fromkeys(told))  # what is prepared again is told again


def _ranked(p: Prepared, s: Solution, scores: Sequence[HeldOutScore]) -> tuple[dict[str, float], tuple[str, ...]]:
    """The share of the error that each effect of the model removes, and their names, the one that does most first: over
    all runs, and where it acts. A friction under one weight is little over all of them, and may be all there is."""
    own = own_scores(p, s)
    shares = {score.name: score.share for score in scores} | {name: share for name, (share, _) in own.items()}
    most = {score.name: max(score.size, score.seen) for score in scores}  # in a run, whether it was fitted or not
    does = {score.name: math.sqrt(score.overall * most[score.name]) for score in scores} | {
        name: much for name, (_, much) in own.items()
    }
    return shares, tuple(sorted(shares, key=lambda name: -does[name]))


def _floors(p: Prepared) -> tuple[Floor, ...]:
    """Of the channels in which one was measured."""
    noise, how, known = p.measured.noise, p.measured.how, p.measured.interval
    return tuple(
        Floor(CHANNEL[c].key, noise.sigma[c], CHANNEL[c].unit, how[c], known.get(c)) for c in WHOLE if c in how
    )


def _shown(
    p: Prepared, empty: Solution, s: Solution, before: Mapping[Key, Array], final: Mapping[Key, Array]
) -> tuple[dict[str, Free], dict[str, Array]]:
    """The free simulation, and all curves: half of what a report costs."""
    simulated = free(p, empty, s, (before, final))
    return simulated, curves(p, before, final) | pictures(p, before, final) | curves_of(simulated)


def _left(baseline: Solution) -> dict[Key, Array]:
    """What the baseline leaves in the fitted runs, with what each run has to itself."""
    return {key: baseline.residual(key) for key in baseline.keys}


def ratios(p: Prepared, e: Mapping[Key, Array]) -> dict[str, float]:
    """RMS over floor, by sensor, on held-out runs."""
    out = {}
    for c in (*WHOLE, "R"):
        keys = [k for k in e if k[1] == c]
        if keys:
            out[CHANNEL[c].key] = p.held_out.ratio(e, keys)
    return out


def unexplained(p: Prepared, e: Mapping[Key, Array]) -> dict[str, float]:
    """Share of the held-out variance the baseline leaves beyond the floor, by sensor."""
    out = {}
    for c in WHOLE:
        keys = [k for k in e if k[1] == c]
        total = sum(float(np.var(p.eq.rows[k].y) * p.eq.rows[k].y.size) for k in keys)
        left = sum(float(e[k] @ e[k]) - p.held_out.floors[k] ** 2 * e[k].size for k in keys)
        if total > 0:
            out[CHANNEL[c].key] = float(np.clip(left / total, 0.0, 1.0))
    return out
