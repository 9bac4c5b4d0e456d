"""The form that fitted runs want most, fitted with everything else, if unseen runs vouch for it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.held_out import HeldOut, left_unseen
from rig.analysis.tracing.free_form.fitted import Fitted, fitted, likeliest, possible
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.thresholds import EVIDENCE
from rig.model.effect import Array
from rig.process.workers import each, give_back

FINER: Final = (2, 4)  # times as fine as the coarsest, while fitted runs want it
DOUBLED: Final = 4  # times as many numbers in a form that is a product of two factors, each twice as fine
WIDEST: Final = 500  # numbers of a form: of 1600, as waves along a curve would have, a search's rows are gigabytes
LIKELY: Final = 8  # forms that few rows speak for most
TRIED: Final = 3  # forms with most evidence that unseen runs are asked about
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
    made = likeliest(p, s, possible(p, coordinate), LIKELY)
    worth = each(lambda form: fitted(p, s, form).worth, made)
    for i in sorted(range(len(made)), key=lambda i: -worth[i])[:TRIED]:
        if worth[i] < EVIDENCE:
            return None
        if found := _vouched_for(p, after, _refined(p, s, coordinate, fitted(p, s, made[i]))):
            return found
    return None


def _refined(p: Prepared, s: Solution, coordinate: str, one: Fitted) -> Fitted:
    """Finer, as long as that is worth its numbers, and they have room."""
    for finer in FINER:
        if DOUBLED * (one.solution.x.size - s.x.size) > WIDEST:
            break
        (again,) = (fitted(p, s, form) for form in possible(p, coordinate, finer) if form.words == one.form.words)
        if again.evidence <= one.evidence:
            break
        one = again
    return one


def _vouched_for(p: Prepared, after: Mapping[Key, Array], one: Fitted) -> Drawn | None:
    """Where unseen runs have less left with it, and no channel of them has more."""
    give_back()
    then = left_unseen(one.solution, p.held_out)
    now, before = (p.held_out.ratio(e, list(e)) for e in (then, after))
    if now > WORTH * before or _spoils(p.held_out, after, then):
        return None
    return Drawn(one.solution, one.form.words, then)


def _spoils(held_out: HeldOut, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> bool:
    channels = [mine for c in WHOLE if (mine := [key for key in before if key[1] == c])]
    return any(held_out.ratio(after, mine) > max(SPOILS * held_out.ratio(before, mine), 1.0) for mine in channels)
