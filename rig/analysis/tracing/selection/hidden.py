"""What is there all the same where unseen runs leave no more than their floor: in the floor, one run, or lock tests."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.of_a_run import leniency
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.bursts import burst, loudest_burst, usual_levels
from rig.analysis.tracing.residual.comes_and_goes import comes_and_goes
from rig.analysis.tracing.residual.for_a_while import for_a_while
from rig.analysis.tracing.residual.foretold import smooth_term
from rig.analysis.tracing.residual.hidden_order import hidden_order
from rig.analysis.tracing.residual.home import WHERE_IT_TURNS_BACK, Home
from rig.analysis.tracing.residual.in_the_floor import in_the_floor
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.levels import friction_by_speed, of_turning
from rig.analysis.tracing.residual.locks import lock_tests_differ
from rig.analysis.tracing.residual.same_spring import same_spring
from rig.analysis.tracing.residual.slipping_order import slipping_order
from rig.analysis.tracing.residual.strikes import striking
from rig.analysis.tracing.residual.ticking import largest, ticking
from rig.analysis.tracing.residual.unknown import home
from rig.analysis.tracing.residual.whose_order import WHOLE_ORDER
from rig.analysis.tracing.runs.alike import alike, repeats
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.next_run import along
from rig.analysis.tracing.selection.sentences import how_often, of_the_rest
from rig.analysis.tracing.thresholds import IN_ONE_RUN, MISSING, NOTEWORTHY
from rig.model.effect import Array
from rig.process.workers import meanwhile


def hidden(p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]) -> Conclusion | None:
    """What unseen runs leave is no more than their floor, but there is something all the same; None where not. What
    foretells unseen runs goes first: it makes single runs and lock tests differ as well."""
    return (
        _in_the_floor(p, s, after, floors)
        or _in_the_spring(p, s, after)
        or _in_friction(p, s, after, floors)
        or _nearly_loud(p, s, after, floors)
        or _in_one_run(p, s)
        or _in_lock_tests(p, s, after)
        or _in_a_burst(p, s)
    )


def _in_the_floor(
    p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]
) -> Conclusion | None:
    """Nothing is above the floor, but the floor itself can be foretold; None where it cannot."""
    left = {key: s.residual(key) for key in s.keys}
    floors = {**floors, **p.held_out.floors}
    of_what = "what unseen runs have beyond what neighbouring turns differ by"
    *most, last = WHOLE  # a channel takes as long as all that is asked first
    with meanwhile(lambda: ticking(p.eq, left, after, most)) as ticks:  # most campaigns ask for both
        home = in_the_floor(p.eq, left, after, floors)
        if home is None:
            here = ticking(p.eq, left, after, [last])
            home = largest([ticks(), here]) or hidden_order(p.eq, left, after, floors)
            of_what = "what unseen runs leave there"
        if home is None and (home := slipping_order(p.eq, left, floors)):
            of_what = "what the runs that show it leave there"
    if home is None:
        return None
    what = "the angle the output has gone"
    if home.frequency_hz:
        what = f"something that comes and goes {how_often(home)}"
    elif home.order:
        shaft = "motor" if home.coordinate == "motor_angle" else "output"
        what = f"something that comes back {home.order:.3f} times a turn of the {shaft}"
    differing = "Repeats" if repeats(p.eq.runs, p.split.fitted) else "Neighbouring turns"
    sentence = (
        f"{differing} differ in {CHANNEL[home.channel].name} because of {what} "
        f"({min(home.share, 1.0):.0%} of {of_what}); it is in the floor, and {_and_no_name(home)}."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), home.coordinate, home.order, home.frequency_hz, sentence)
    return Conclusion(verdict, home, (home.coordinate,), along(home.coordinate))


def _and_no_name(found: Home) -> str:
    """That nothing is named for it: a runout and a weight come back so too, and are above no floor that has them."""
    order = found.order or 0.0
    if found.coordinate == "load_angle" and any(abs(order - n) < WHOLE_ORDER for n in (1, 2)):
        return "whether a runout, a weight or another thing does so these runs do not tell"
    return "no effect of the library explains it"


def _in_the_spring(p: Prepared, s: Solution, after: Mapping[Key, Array]) -> Conclusion | None:
    """Repeats differ by what their torque winds up; None where they do not."""
    left = {key: s.residual(key) for key in s.keys}
    found = same_spring(p.eq, {**left, **after}, s.value("compliance"))
    if found is None:
        return None
    verdict = Verdict(Status.UNKNOWN, (), (), "time", None, None, found.sentence())
    return Conclusion(verdict, None, ("time",), along("time"))


def _in_friction(
    p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]
) -> Conclusion | None:
    """No run has more left than its floor, but all runs of a while, or at one speed, have the same more, or it comes
    and goes; None where they have not."""
    left, floors = {key: s.residual(key) for key in s.keys}, {**floors, **p.held_out.floors}
    rests = of_turning(p.eq, {**left, **after}, floors)
    if (found := for_a_while(p.eq, rests, floors)) is not None:
        verdict = Verdict(Status.UNKNOWN, (), (), "time", None, None, found.sentence())
        return Conclusion(verdict, None, ("time",), along("time"))
    if (wave := comes_and_goes(p.eq, rests, floors)) is not None:
        verdict = Verdict(Status.UNKNOWN, (), (), "time_periodic", None, wave.frequency_hz, wave.sentence())
        return Conclusion(verdict, None, ("time_periodic",), along("time_periodic"))
    return _at_one_speed(rests)


def _at_one_speed(rests: Mapping[str, Rest]) -> Conclusion | None:
    home = friction_by_speed(rests)
    if home is None:
        return None
    sentence = (
        f"Friction in {CHANNEL[home.channel].name} is another one at some speeds, the same in all runs at them "
        f"({home.share:.0%} of what runs differ by): less than the floor of one run, and no effect of the library "
        "could be named for it."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), home.coordinate, None, None, sentence)
    return Conclusion(verdict, home, (home.coordinate,), along(home.coordinate))


def _nearly_loud(
    p: Prepared, s: Solution, after: Mapping[Key, Array], floors: Mapping[Key, float]
) -> Conclusion | None:
    """A channel of unseen runs has a little more left than repeats tell of, and nearly all of that is foretold along
    one coordinate; None where there is none."""
    if not repeats(p.eq.runs, p.split.fitted):
        return None
    left, floors = {key: s.residual(key) for key in s.keys}, {**floors, **p.held_out.floors}
    for c in WHOLE:
        mine = [key for key in after if key[1] == c]
        if not mine or (before := p.held_out.beside_chance(after, mine, NOTEWORTHY)) < NOTEWORTHY:
            continue
        where = home(p.eq, {key: e for key, e in left.items() if key[1] == c}, floors)
        if where and p.held_out.ratio(smooth_term(p.eq, left, after, floors, where[0]), mine) < 1.0:
            best = where[0]
            verdict = Verdict(
                Status.UNKNOWN, (), (), best.coordinate, best.order, best.frequency_hz, of_the_rest(best, before)
            )
            return Conclusion(verdict, best, (best.coordinate,), along(best.coordinate))
    return None


def _in_one_run(p: Prepared, s: Solution) -> Conclusion | None:
    """Unseen runs leave nothing, but a fitted one has far more left than its floor; None where there is none.

    A run like it that has nothing left says that something happened in the one; a part of itself says nothing.
    """
    over = {k: float(np.sqrt(np.mean(s.residual(k) ** 2))) / p.floors[k] for k in s.keys if k[1] != "R"}
    worst = max(over, key=lambda k: over[k])
    if over[worst] < IN_ONE_RUN * leniency(p.measured, p.eq, worst):
        return None
    run = p.eq.runs[worst[0]]
    quiet = [k for k, ratio in over.items() if ratio < MISSING] + [*p.held_out.floors]
    others = [p.eq.runs[i] for i, c in quiet if c == worst[1] and whole_run(p.eq.runs[i].name) != whole_run(run.name)]
    twins = [other for other in others if alike(other, run)]
    left = f"{run.name} has {over[worst]:.1f} times the floor left in {CHANNEL[worst[1]].name}"
    if twins:
        coordinate = "time"
        what = f", which {twins[0].name}, taken alike, has not: something happened in that run"
    else:
        where = home(p.eq, {k: s.residual(k) for k in s.keys}, p.floors)
        if run.locked:  # all that it does comes and goes with its one or two cycles
            where = [found for found in where if found.coordinate != "time_periodic"]
        coordinate = (where or [WHERE_IT_TURNS_BACK])[0].coordinate
        said = "no run taken alike is without it"
        if not _is_repeated(p, run):
            said = "no other run was taken like it, so that none can say whether it comes again"
        what = f", and {said}; it lives in {coordinate.replace('_', ' ')}"
    sentence = f"{left}{what}. No effect of the library explains it; unseen runs leave nothing."
    verdict = Verdict(Status.UNKNOWN, (), (), coordinate, None, None, sentence)
    return Conclusion(verdict, None, (coordinate,), along(coordinate))


def _is_repeated(p: Prepared, run: Recording) -> bool:
    """Whether another run was taken alike."""
    every = [p.eq.runs[i] for i in (*p.split.fitted, *p.split.held_out)]
    return any(alike(other, run) for other in every if whole_run(other.name) != whole_run(run.name))


def _in_a_burst(p: Prepared, s: Solution) -> Conclusion | None:
    """Seconds of a fitted run that stand out against the rest of it; None where none do. They have raised the floor."""
    e = {key: s.residual(key) for key in s.keys}
    found = loudest_burst(p.eq, e)
    if found is None:
        return None
    run, channel = p.eq.runs[found.key[0]], CHANNEL[found.key[1]].name
    others = [
        key[0] for key in e if key[1] == found.key[1] and whole_run(p.eq.runs[key[0]].name) != whole_run(run.name)
    ]
    twins = [i for i in others if alike(p.eq.runs[i], run)]
    quiet = [i for i in twins if burst(p.eq, (i, found.key[1]), e[i, found.key[1]]) is None]
    if quiet:
        coordinate, what = "time", f"{p.eq.runs[quiet[0]].name}, taken alike, does not: something happened there"
    else:
        levels = usual_levels(p.eq, {key: x for key, x in e.items() if key[1] == found.key[1]})
        where = home(p.eq, {key: e[key] for key in levels}, levels)
        coordinate = where[0].coordinate if where else "time"
        what = f"it lives in {coordinate.replace('_', ' ')}"
    hz = None if quiet else striking(p.eq, e, found.key[1])
    if hz is not None:
        coordinate = "time_periodic"
        what = f"such seconds come evenly, every {1.0 / hz:.3g} s, in the runs that have several"
    when = f"{found.since:.1f} and {found.until:.1f} s"
    if not p.eq.timed:
        when = f"rows {found.since * run.rate:.0f} and {found.until * run.rate:.0f}"
    sentence = (
        f"Between {when} {run.name} stands out in {channel}, which makes all of it "
        f"{found.over:.1f} times its usual half second; {what}. It is in the floor, and no effect of the library "
        "explains it."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), coordinate, None, hz, sentence)
    return Conclusion(verdict, None, (coordinate,), along(coordinate))


def _in_lock_tests(p: Prepared, s: Solution, after: Mapping[Key, Array]) -> Conclusion | None:
    left = {key: s.residual(key) for key in s.keys}
    found = lock_tests_differ(p.eq, p.measured, {**left, **after})
    if found is None:
        return None
    home, times = found
    what = f"comes and goes {how_often(home)}" if home.frequency_hz else f"follows the {home.coordinate}"
    sentence = (
        f"Lock tests differ by {times:.1f} times what runs that turn freely do: the stiffness is not the same twice, "
        f"and {what} ({min(home.share, 1.0):.0%} of it); it is in the floor, and no effect of the library explains it."
    )
    verdict = Verdict(Status.UNKNOWN, (), (), home.coordinate, None, home.frequency_hz, sentence)
    return Conclusion(verdict, None, (home.coordinate,), along(home.coordinate))
