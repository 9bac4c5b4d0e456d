"""The form that fitted runs want most, fitted with everything else, if unseen runs vouch for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Key, Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.floor.held_out import HeldOut, unseen
from rig.analysis.tracing.free_form.form import FreeForm
from rig.analysis.tracing.free_form.forms import forms
from rig.analysis.tracing.free_form.ranges import ranges
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.thresholds import EVIDENCE
from rig.analysis.tracing.workers import each
from rig.model.effect import Array

FINER: Final = (2, 4)  # times as fine as the coarsest, while fitted runs want it
TRIED: Final = 3  # forms with most evidence that unseen runs are asked about
SURFACE: Final = 0.9  # of its evidence
RIDGE: Final = 1e-6  # of a column's square: some are sums of others, and of the baseline's
WORTH: Final = 0.95  # of what unseen runs leave, RMS: a form that takes less is none to tell of
SPOILS: Final = 1.05  # times: what a channel of unseen runs may have more with it


@dataclass(frozen=True)
class Drawn:
    """The model with a form in it, in words where that acts, and what unseen runs leave, (n,) by block."""

    solution: Solution
    words: str
    after: dict[Key, Array]


def drawn(p: Prepared, s: Solution, after: Mapping[Key, Array], coordinate: str) -> Drawn | None:
    """With the best form along that coordinate; None where fitted runs want none, or unseen runs vouch for none."""
    made = _forms(p, coordinate, 1)
    worth = each(lambda form: _worth(_with(p, s, form)), made)
    for i in sorted(range(len(made)), key=lambda i: -worth[i])[:TRIED]:
        if worth[i] < EVIDENCE:
            return None
        if found := _vouched_for(p, after, _refined(p, s, coordinate, _with(p, s, made[i]))):
            return found
    return None


@dataclass(frozen=True)
class _Fitted:
    form: FreeForm
    solution: Solution
    evidence: float  # nats


def _worth(one: _Fitted) -> float:
    """Its evidence; of a surface, which draws whatever a curve does and some of the noise, a tenth less."""
    return one.evidence * (SURFACE if one.form.surface else 1.0)


def _forms(p: Prepared, coordinate: str, finer: int) -> list[FreeForm]:
    """Those that what all fitted runs read can show."""
    runs = [p.eq.runs[i] for i in p.split.fitted]
    has = frozenset.intersection(*(run.has for run in runs))
    return [form for form in forms(coordinate, ranges(runs), finer) if form.wants <= has]


def _with(p: Prepared, s: Solution, form: FreeForm) -> _Fitted:
    d = extended(s.design, Term(form, ()), p.split.fitted)
    mine = np.arange(s.design.size, d.size)
    gram = d.gram.copy()
    gram[mine, mine] *= 1 + RIDGE
    made = fit(replace(d, gram=gram))
    rows = sum(d.y[key].size / d.eq.noise.kappa[key[1]] for key in s.keys)
    return _Fitted(form, made, (made.gain - s.gain) / 2 - mine.size / 2 * float(np.log(rows)))


def _refined(p: Prepared, s: Solution, coordinate: str, one: _Fitted) -> _Fitted:
    """Finer, as long as that is worth its numbers      [hastie2009, Sec. 7.7]"""
    for finer in FINER:
        (again,) = (_with(p, s, form) for form in _forms(p, coordinate, finer) if form.words == one.form.words)
        if again.evidence <= one.evidence:
            break
        one = again
    return one


def _vouched_for(p: Prepared, after: Mapping[Key, Array], one: _Fitted) -> Drawn | None:
    """Where unseen runs have less left with it, and no channel of them has more."""
    then = p.held_out.residuals(one.solution, unseen(one.solution, p.held_out))
    now, before = (p.held_out.ratio(e, list(e)) for e in (then, after))
    if now > WORTH * before or _spoils(p.held_out, after, then):
        return None
    return Drawn(one.solution, one.form.words, then)


def _spoils(held_out: HeldOut, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> bool:
    channels = [[key for key in before if key[1] == c] for c in WHOLE]
    return any(
        held_out.ratio(after, mine) > max(SPOILS * held_out.ratio(before, mine), 1.0) for mine in channels if mine
    )
