"""What may be said: explained, nothing missing, unknown, ambiguous."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from rig.analysis.tracing.court.judge import Worth
from rig.analysis.tracing.court.next_run import along, deciding
from rig.analysis.tracing.court.shadows import SHADOWS, Shadow, cast
from rig.analysis.tracing.court.suspects import IN_WORDS
from rig.analysis.tracing.fit.channels import CHANNELS, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.floor.local import IN_SHORT
from rig.analysis.tracing.floor.noise import leniency
from rig.analysis.tracing.floor.repeats import alike, repeats
from rig.analysis.tracing.outcome.result import NextRun, Status, Verdict
from rig.analysis.tracing.rest.hidden_order import hidden_order
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.in_the_floor import in_the_floor
from rig.analysis.tracing.rest.locks import lock_tests_differ
from rig.analysis.tracing.rest.ticking import largest, ticking
from rig.analysis.tracing.rest.unknown import home
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.thresholds import ALONE, AMISS, EXPLAINED, IN_ONE_RUN, MISSING, MOSTLY, PART
from rig.analysis.tracing.workers import meanwhile
from rig.model.effect import Array
from rig.model.effects import CATALOGUE, LIBRARY

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared


FORETELLS_NOTHING: Final = 0.05  # of the excess: so much is chance
WHERE_IT_TURNS_BACK: Final = Home("memory", "R", 1.0)
"""What stands only where the motor turns back remembers the way since then."""


@dataclass(frozen=True)
class Ruling:
    """The verdict, and what follows from it."""

    verdict: Verdict
    home: Home | None
    lives_in: tuple[str, ...]
    next_run: NextRun | None
    cannot: tuple[str, ...] = ()


def decide(
    p: Prepared,
    s: Solution,
    weighed: Sequence[str],
    worths: Sequence[Worth],
    before: Mapping[Key, Array],
    after: Mapping[Key, Array],
    floors: Mapping[Key, float],
    found: Found,
) -> Ruling:
    """From held-out ratios and the effects that may be named, `weighed`, the one that does most first; those shared by
    all runs have `worths`."""
    total, _ = p.court.worst(after)
    first, _ = p.court.worst(before)
    line = p.own.line
    names = tuple(name for name in weighed if name not in SHADOWS)
    one = MISSING if names else ALONE
    loud = p.court.loud(after, one, bool(names)) or line is not None
    plain = {w.name for w in worths if w.plain}
    if shadows := [shadow for shadow in cast(s) if not loud or shadow.effect.name in plain]:
        return _cast(shadows[0], _standing(shadows[0].coordinate, names, worths, plain))
    done = 1 - max(0.0, total**2 - 1) / max(first**2 - 1, 1e-9)
    if not loud:
        hidden = None if names else _hidden(p, s, after, floors)
        return hidden or _settled(p, names, found, *_falls(p, before, after))
    where = _where(p, s, after, floors, one)
    known = bool(repeats(p.eq.runs, p.split.fitted))  # without repeats no floor is known so well that a rest may stand
    mostly = done > MOSTLY and total < 2 * EXPLAINED and max((w.left for w in worths), default=0.0) < AMISS
    sure = known or (bool(plain) and all(w.name in plain for w in worths))
    if line is None and names and sure and mostly:
        ruling = _settled(p, names, found, first, total)
        return Ruling(ruling.verdict, None, _lives(where), ruling.next_run)
    # steps and phases that runs have to themselves take on whatever there is; a line in a sensor is in the columns made
    # from it too
    shared = [name for name in names if name not in p.own.made]
    told = line is None and (known or total <= EXPLAINED)
    best, taken = where[0], _share(*_most(p, before, after))
    stand = _standing(best.coordinate, shared, worths, plain, told) if taken > PART else ()
    sentence = line.sentence() if line is not None else _of_the_rest(best, total)
    if stand:
        sentence = f"{_lacks(stand, *_most(p, before, after), 'most improved')} {sentence}"
    verdict = Verdict(Status.UNKNOWN, stand, (), best.coordinate, best.order, best.frequency_hz, sentence)
    return Ruling(verdict, best, _lives(where), along(best.coordinate))


def _where(p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float], one: float) -> list[Home]:
    """Where what is left lives, the best first: a line in a sensor, then by coordinate; at reversals alone where no
    channel has more left elsewhere than may be in `one` run."""
    line = p.own.line
    elsewhere = {key: e for key, e in after.items() if key[1] != "R"}
    where = [WHERE_IT_TURNS_BACK]
    if line is not None or p.court.loud(elsewhere, one):
        where = home(p.eq, {key: s.residual(key) for key in s.keys}, floors)
    if line is not None:
        where = [Home("time_periodic", line.channel, line.share, frequency_hz=line.frequency_hz), *where]
    return where


def _hidden(p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]) -> Ruling | None:
    """What unseen runs leave is no more than their floor, but there is something all the same; None where not. What
    foretells unseen runs goes first: it makes single runs and lock tests differ as well."""
    return _in_the_floor(p, s, after, floors) or _in_one_run(p, s) or _in_lock_tests(p, s, after)


def _in_lock_tests(p: Prepared, s: Solution, after: Mapping[Key, Array]) -> Ruling | None:
    left = {key: s.residual(key) for key in s.keys}
    found = lock_tests_differ(p.eq, p.measured, {**left, **after})
    if found is None:
        return None
    home, times = found
    what = f"comes and goes {_how_often(home)}" if home.frequency_hz else f"follows the {home.coordinate}"
    sentence = (
        f"Lock tests differ by {times:.1f} times what runs that turn freely do: the stiffness is not the same twice, "
        f"and {what} ({min(home.share, 1.0):.0%} of it); it is in the floor, and no effect of the library explains it."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), home.coordinate, None, home.frequency_hz, sentence)
    return Ruling(verdict, None, (home.coordinate,), along(home.coordinate))


def _in_one_run(p: Prepared, s: Solution) -> Ruling | None:
    """Unseen runs leave nothing, but a fitted one has far more left than its floor; None where there is none.

    A run like it that has nothing left says that something happened in the one; a part of itself says nothing.
    """
    over = {k: float(np.sqrt(np.mean(s.residual(k) ** 2))) / p.floors[k] for k in s.keys if k[1] != "R"}
    worst = max(over, key=lambda k: over[k])
    if over[worst] < IN_ONE_RUN * leniency(p.measured, p.eq, worst):
        return None
    run = p.eq.runs[worst[0]]
    quiet = [k for k, ratio in over.items() if ratio < MISSING] + [*p.court.floors]
    others = [p.eq.runs[i] for i, c in quiet if c == worst[1] and whole_run(p.eq.runs[i].name) != whole_run(run.name)]
    twins = [other for other in others if alike(other, run)]
    left = f"{run.name} has {over[worst]:.1f} times the floor left in {IN_WORDS[worst[1]]}"
    if twins:
        coordinate = "time"
        what = f", which {twins[0].name}, taken alike, has not: something happened in that run"
    else:
        where = home(p.eq, {k: s.residual(k) for k in s.keys}, p.floors) or [WHERE_IT_TURNS_BACK]
        coordinate = where[0].coordinate
        what = f", and no run taken alike is without it; it lives in {coordinate.replace('_', ' ')}"
    sentence = f"{left}{what}. No effect of the library explains it; unseen runs leave nothing."
    verdict = Verdict(Status.UNKNOWN, (), (), coordinate, None, None, sentence)
    return Ruling(verdict, None, (coordinate,), along(coordinate))


def _in_the_floor(p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]) -> Ruling | None:
    """Nothing is above the floor, but the floor itself can be foretold; None where it cannot."""
    left = {key: s.residual(key) for key in s.keys}
    floors = {**floors, **p.court.floors}
    of_what = "what unseen runs have beyond what neighbouring turns differ by"
    *most, last = WHOLE  # a channel takes as long as all that is asked first
    with meanwhile(lambda: ticking(p.eq, left, after, most)) as ticks:  # most campaigns ask for both
        home = in_the_floor(p.eq, left, after, floors)
        if home is None:
            here = ticking(p.eq, left, after, [last])
            home = largest([ticks(), here]) or hidden_order(p.eq, left, after, floors)
            of_what = "what unseen runs leave there"
    if home is None:
        return None
    what = "the angle the output has gone"
    if home.frequency_hz:
        what = f"something that comes and goes {_how_often(home)}"
    elif home.order:
        what = f"something that comes back {home.order:.3f} times a turn of the motor"
    differing = "Repeats" if repeats(p.eq.runs, p.split.fitted) else "Neighbouring turns"
    sentence = (
        f"{differing} differ in {IN_WORDS[home.channel]} because of {what} ({min(home.share, 1.0):.0%} of {of_what}); "
        "it is in the floor, and no effect of the library explains it."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), home.coordinate, home.order, home.frequency_hz, sentence)
    return Ruling(verdict, home, (home.coordinate,), along(home.coordinate))


def _how_often(home: Home) -> str:
    """In words; seconds where it takes some."""
    hz = home.frequency_hz or 0.0
    return f"every {1 / hz:.3g} s of the campaign's clock" if hz < 1 else f"{hz:.2f} times a second, whatever the speed"


def _falls(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> tuple[float, float]:
    """RMS over floor of the worst channel without and with what was found; without reversals where they have a little
    left."""
    total, _ = p.court.worst(after)
    if total > EXPLAINED:
        before, after = ({key: x for key, x in e.items() if key[1] != "R"} for e in (before, after))
    return p.court.worst(before)[0], p.court.worst(after)[0]


def _cast(shadow: Shadow, names: tuple[str, ...]) -> Ruling:
    """A law that is no effect of the library is in the model, which has it by then: no other term is added."""
    verdict = Verdict(Status.UNKNOWN, names, (), shadow.coordinate, None, None, shadow.sentence)
    return Ruling(verdict, None, (shadow.coordinate,), along(shadow.coordinate))


def _standing(
    coordinate: str, names: Sequence[str], worths: Sequence[Worth], plain: Collection[str], told: bool = True
) -> tuple[str, ...]:
    """Names that stand beside a rest: those `plain` to see; and where it can be `told` what much is, those beside which
    nothing is left in any channel they act in, nor in the runs they act in most."""
    amiss = {w.name for w in worths if max(w.anywhere, w.left) > MISSING}
    clean = _beside(coordinate, [name for name in names if name not in amiss]) if told else ()
    return tuple(name for name in names if name in plain or name in clean)


def _beside(coordinate: str, names: Sequence[str]) -> tuple[str, ...]:
    """Names that may stand beside a rest: one with memory would give its share to any law that remembers, and the mean
    curve of its loop to one that bends the spring."""
    if coordinate != "memory":
        return tuple(names)
    return tuple(name for name in names if not (LIBRARY[name].remembers or LIBRARY[name].backbone))


def _most(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> tuple[float, float]:
    """RMS over floor without and with what was found, of the channel that gains most."""
    keys = [[k for k in after if k[1] == c] for c in CHANNELS]
    pairs = [(p.court.ratio(before, mine), p.court.ratio(after, mine)) for mine in keys if mine]
    return max(pairs, key=lambda pair: pair[0] - pair[1])


def _share(before: float, after: float) -> float:
    """Of the excess over the floor, what has gone."""
    return (before**2 - after**2) / max(before**2 - 1.0, 1e-9)


def _of_the_rest(best: Home, total: float) -> str:
    where = best.coordinate.replace("_", " ")
    if best.share < FORETELLS_NOTHING:
        return (
            f"What is left is {total:.1f} times the floor and follows no effect of the library; no coordinate that was "
            f"tried foretells it, {where} comes nearest."
        )
    return (
        f"What is left is {total:.1f} times the floor and follows no effect of the library; it lives in "
        f"{where} ({min(best.share, 1.0):.0%} of it)"
        + (f", order {best.order:.2f}" if best.order else "")
        + (f", {best.frequency_hz:.2f} Hz" if best.frequency_hz else "")
        + "."
    )


def _lacks(names: Sequence[str], before: float, after: float, of: str = "worst") -> str:
    them = "them" if len(names) > 1 else "it"
    return (
        f"The model lacks {_in_words(names)}: with {them} the {of} held-out error of a channel falls from {before:.1f} "
        f"to {after:.2f} times the floor."
    )


def _in_words(names: Sequence[str]) -> str:
    return _listed([f"{name.replace('_', ' ')} ({_in_short(name)})" for name in names])


def _in_short(name: str) -> str:
    return CATALOGUE[name].in_short if name in CATALOGUE else IN_SHORT[name]


def _lives(where: Sequence[Home]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(h.coordinate for h in where if h.share > 0.3))[:3]


def _settled(p: Prepared, names: tuple[str, ...], found: Found, before: float, after: float) -> Ruling:
    """Nothing loud remains."""
    if not names:
        sentence = f"Nothing is missing: the baseline leaves {after:.2f} times the floor on held-out runs."
        return Ruling(Verdict(Status.NOTHING, (), (), None, None, None, sentence), None, (), None)
    rivals, next_run = deciding(p, names, found)
    sentence = _lacks(names, before, after)
    if all(name in p.own.made and not p.own.made[name].keys() & p.court.floors.keys() for name in names):
        sentence = f"The model lacks {_in_words(names)}: fitted runs show it, held-out ones have none of it."
    if rivals:
        sentence = f"{sentence} These data fit as well with {', '.join(rivals)}."
    status = Status.AMBIGUOUS if rivals else Status.EXPLAINED
    return Ruling(Verdict(status, names, rivals, None, None, None, sentence), None, (), next_run)


def _listed(words: Sequence[str]) -> str:
    """a, b and c."""
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
