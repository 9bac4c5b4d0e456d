"""What may be said: explained, nothing missing, unknown, ambiguous."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.answer import Status, Verdict
from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.steps import LOST
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.residual.bent_sensor import SPRINGS, is_the_sensors
from rig.analysis.tracing.residual.drifting_zeros import drifting_zeros
from rig.analysis.tracing.residual.gains_of_locks import gains_of_locks
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import loudness
from rig.analysis.tracing.residual.lives import SOME
from rig.analysis.tracing.residual.uneven_drag import UnevenDrag, uneven_drag
from rig.analysis.tracing.residual.uneven_friction import UnevenFriction, uneven_friction
from rig.analysis.tracing.residual.warm_zeros import warm_zeros
from rig.analysis.tracing.residual.zeros_by_load import zeros_by_load
from rig.analysis.tracing.residual.zeros_by_speed import zeros_by_speed
from rig.analysis.tracing.residual.zeros_by_way import zeros_by_way
from rig.analysis.tracing.runs.cannot import see_little
from rig.analysis.tracing.runs.recording import read_by_any
from rig.analysis.tracing.selection.asked import Asked
from rig.analysis.tracing.selection.beside_a_law import beside_a_law, beside_little, confounded, larger_than
from rig.analysis.tracing.selection.conclusion import Conclusion
from rig.analysis.tracing.selection.confounders import confounders_in
from rig.analysis.tracing.selection.falls import most, share, share_of_all
from rig.analysis.tracing.selection.hidden import hidden
from rig.analysis.tracing.selection.inseparable import inseparable, whose_spring, winds_up
from rig.analysis.tracing.selection.next_run import along, by_table, deciding
from rig.analysis.tracing.selection.sentences import in_words, lacks, nothing, of_the_rest
from rig.analysis.tracing.selection.standing import standing
from rig.analysis.tracing.selection.where import where_left
from rig.analysis.tracing.thresholds import AMISS, EXPLAINED, LITTLE, MOSTLY, PART, QUIET
from rig.model.effect import Array

DRIFTS: Final = 3.0  # floors: zeros that drift by less matter to nobody, and wander so now and then
SAME_ORDER: Final = 0.05  # of a turn
ALONG_THE_OUTPUT: Final = {"A": "output_once_per_rev", "L": "torque_sensor_crosstalk"}  # a few orders of its turn
AT_THE_START: Final = {"stribeck_friction"}  # more where a motor is slow, and so is what wears off after a start
FORETOLD_BY_CHANCE: Final = 0.3  # of the excess
QUIETER: Final = 0.95  # of what was left before: less than that is no fall to tell of


def decide(asked: Asked) -> Conclusion:
    """The verdict, from held-out residuals and the effects that may be named."""
    return _whose_curve(asked, whose_spring(_decided(asked)))


def _whose_curve(asked: Asked, said: Conclusion) -> Conclusion:
    """Of a spring that is not linear in a torque that the load does not feel: the sensor is not, and no name."""
    if not is_the_sensors(asked.s, said.verdict.effects, [*asked.p.split.fitted, *asked.p.split.held_out]):
        return said
    stand = tuple(name for name in said.verdict.effects if name not in SPRINGS)
    sentence = (
        "The torque sensor is not linear: what it reads off winds nothing up, and the weights that were declared tell "
        "of it as much as the wind-up does. No effect of the library does so."
    )
    verdict = Verdict(Status.UNKNOWN, stand, (), "load", None, None, sentence)
    return Conclusion(verdict, said.home, ("load",), along("load"))


def _decided(asked: Asked) -> Conclusion:
    p, s, names = asked.p, asked.s, asked.names
    if said := _by_a_law(asked):
        return said
    if not asked.loud:
        inside = None if names else hidden(p, s, asked.after, asked.floors)
        beside = asked.sized  # of what may as well be nothing no name stands beside something else
        elsewhere = inside or _drifting(p, s, beside, asked.floors) or _uneven(p, s, beside, asked.floors)
        elsewhere = elsewhere or (None if names else _weakening(p, s))
        return elsewhere or _jumped(p, beside) or _settled(asked, names, *_falls(p, asked.before, asked.after))
    if not names and asked.worst[1] < LITTLE and (drift := _drifting(p, s, names, asked.floors)):
        return drift  # of many floors, which no error shows: the little that is left is what of it falls within runs
    if drag_one_way := _loads_drag(asked):
        return drag_one_way
    where = where_left(p, s, asked.after, asked.floors, asked.one)
    return _with_a_remainder(asked, where) or _unknown(asked, where)


def _by_a_law(asked: Asked) -> Conclusion | None:
    """A law without a name is in the model, beside names or alone; None where there is none."""
    p, names, scores, plain = asked.p, asked.names, asked.scores, asked.plain
    stands = not asked.loud or (not names and _done(asked) > MOSTLY)  # what it leaves is what it has wrong of its form
    laws = [law for law in confounders_in(asked.s) if stands or law.effect.name in plain]
    if not laws:
        return None
    own = p.own.made.keys() if not asked.loud or _done(asked) > MOSTLY else ()
    stand = beside_a_law(laws[0].coordinate, asked.sized, scores, plain, own)
    larger = () if asked.loud else larger_than(laws, names, scores, plain)
    if not larger:
        return confounded(laws[0], stand)
    named = tuple(name for name in names if name in stand or name in larger)
    return beside_little(laws[0], _settled(asked, named, *_falls(p, asked.before, asked.after)))


def _with_a_remainder(asked: Asked, where: Sequence[Home]) -> Conclusion | None:
    """Names explain nearly all there was, and what is left beside them is little; None where they do not."""
    first, total = asked.worst
    left = max((score.left for score in asked.scores), default=0.0)
    mostly = _done(asked) > MOSTLY and total < 2 * EXPLAINED and left < AMISS
    all_plain = bool(asked.plain) and all(x.name in asked.plain or x.all_there_is for x in asked.scores)
    again_and_again = asked.p.own.many and asked.names == (LOST.name,)  # of so many counts a few are never found
    sure = asked.has_repeats or all_plain or again_and_again
    if asked.p.own.line is not None or not (asked.names and sure and mostly):
        return None
    conclusion = _settled(asked, asked.names, first, total)
    return Conclusion(conclusion.verdict, where[0], _lives(where), conclusion.next_run)


def _done(asked: Asked) -> float:
    """Share of the excess of the worst channel that is gone with the model."""
    first, total = asked.worst
    return 1 - max(0.0, total**2 - 1) / max(first**2 - 1, 1e-9)


def _unknown(asked: Asked, where: Sequence[Home]) -> Conclusion:
    """Much is left, and no effect explains it; names whose own part is plain stand beside it."""
    p, before, after = asked.p, asked.before, asked.after
    line, best, (_, total) = p.own.line, where[0], asked.worst
    if line is None and not asked.names and is_next_to_nothing(best, total):
        return _settled(asked, (), *asked.worst)
    # steps and phases that runs have to themselves take on whatever there is; a line in a sensor is in the columns made
    # from it too
    other = _of_the_same_order(asked.s, best) | _along_the_same_turn(best)
    other |= AT_THE_START if best.coordinate == "memory" and best.first else set()
    shared = [name for name in asked.measured if name not in p.own.made and name not in other]
    told = line is None and (asked.has_repeats or total <= EXPLAINED)
    taken = min(share(*most(p.held_out, before, after)), share_of_all(p.held_out, before, after))
    stand = standing(best.coordinate, shared, asked.scores, asked.plain, told) if taken > PART else ()
    stand = winds_up(stand, best.coordinate, read_by_any(p.eq.runs))
    sentence = line.sentence() if line is not None else of_the_rest(best, total)
    if stand:
        sentence = f"{lacks(stand, *most(p.held_out, before, after), 'most improved')} {sentence}"
    verdict = Verdict(Status.UNKNOWN, stand, (), best.coordinate, best.order, best.frequency_hz, sentence)
    return Conclusion(verdict, best, _lives(where), along(best.coordinate))


def is_next_to_nothing(best: Home, total: float) -> bool:
    """Whether what is left is little, and little of it is foretold by any coordinate: friction that scatters within
    runs leaves as much where repeats at another speed tell the floor. An effect is foretold by something."""
    return total < LITTLE and best.share < FORETOLD_BY_CHANCE


def _falls(p: Prepared, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> tuple[float, float]:
    """RMS over floor of the worst channel without and with what was found; without reversals where they have a little
    left, unless what was found acts there alone."""
    total, _ = p.held_out.worst(after)
    if total > EXPLAINED:
        elsewhere = [{key: x for key, x in e.items() if key[1] != "R"} for e in (before, after)]
        if p.held_out.worst(elsewhere[0])[0] > QUIET:
            before, after = elsewhere
    return p.held_out.worst(before)[0], p.held_out.worst(after)[0]


def _drifting(p: Prepared, s: Solution, names: tuple[str, ...], floors: Mapping[Key, float]) -> Conclusion | None:
    """Little or nothing is above the floor, but the zeros of the runs follow the temperature, drift, or go with
    speed or load, by more than it; None where they do not. Names stand beside it."""
    ways = (
        ("temperature", warm_zeros),
        ("time", drifting_zeros),
        ("speed", zeros_by_speed),
        ("speed", zeros_by_way),
        *(() if names else (("load", zeros_by_load),)),  # what a name has wrong of its law goes with the load
    )
    found = ((where, of(s, p.split.fitted, p.split.unseen)) for where, of in ways)
    where, drift = next(((where, one) for where, one in found if one is not None), ("", None))
    if drift is None or abs(drift.size) < DRIFTS * np.median([x for (_, c), x in floors.items() if c == "A"]):
        return None
    verdict = Verdict(Status.UNKNOWN, names, (), where, None, None, drift.sentence())
    return Conclusion(verdict, None, (where,), along(where))


def _weakening(p: Prepared, s: Solution) -> Conclusion | None:
    """Nothing is above the floor, but the torque constant is another one in each lock test; None where it is not."""
    gains = gains_of_locks(s, [*p.split.fitted, *p.split.held_out])
    if gains is None:
        return None
    verdict = Verdict(Status.UNKNOWN, (), (), "time", None, None, gains.sentence())
    return Conclusion(verdict, None, ("time",), along("time"))


def _jumped(p: Prepared, names: tuple[str, ...]) -> Conclusion | None:
    """Nothing is above the floor beside a jump under load that may be of three kinds; None where there is none."""
    if p.own.jumped is None:
        return None
    verdict = Verdict(Status.UNKNOWN, names, (), "time", None, None, p.own.jumped.sentence())
    return Conclusion(verdict, None, ("time",), along("time"))


def _uneven(p: Prepared, s: Solution, names: tuple[str, ...], floors: Mapping[Key, float]) -> Conclusion | None:
    """Nothing is above the floor, but the motor's friction or its drag is another one each way; None where neither is.
    Names stand beside it."""
    floor = {c: float(np.median(some)) for c in "ML" if (some := [x for (_, k), x in floors.items() if k == c])}
    runs = (p.split.fitted, p.split.unseen)
    friction = uneven_friction(p.campaign.runs, floor["M"], s.value("tau_l0")) if "M" in floor else None
    drags = (uneven_drag(s, *runs, loud, channel) for channel, loud in floor.items())
    uneven = friction or next((drag for drag in drags if drag), None)
    return None if uneven is None else _one_way(uneven, names)


def _loads_drag(asked: Asked) -> Conclusion | None:
    """Nothing is above the floor but in the load's balance, where a drag that is more one way leaves what its runs'
    zeros do not take on; None where there is no such drag."""
    p = asked.p
    loud = [channel for channel, square in loudness(asked.after, p.held_out.floors).items() if square > QUIET**2]
    floors = [x for (_, c), x in asked.floors.items() if c == "L"]
    if loud != ["L"] or not floors:
        return None
    drag = uneven_drag(asked.s, p.split.fitted, p.split.unseen, float(np.median(floors)), "L")
    return None if drag is None else _one_way(drag, asked.sized)


def _one_way(uneven: UnevenFriction | UnevenDrag, names: tuple[str, ...]) -> Conclusion:
    verdict = Verdict(Status.UNKNOWN, names, (), "direction", None, None, uneven.sentence())
    return Conclusion(verdict, None, ("direction",), along("direction"))


def _of_the_same_order(s: Solution, rest: Home) -> set[str]:
    """Effects of the order of the motor angle that is left: what makes a wave in the angle makes one in the torque too,
    and a torque that leaves it there is not what makes both."""
    if rest.coordinate != "motor_angle" or rest.order is None:
        return set()
    orders = [(t.name, t.shape[0]) for t in s.design.terms if t.effect.shape_names[:1] == ("order",)]
    return {name for name, order in orders if abs(order - rest.order) < SAME_ORDER}


def _along_the_same_turn(rest: Home) -> set[str]:
    """Effects that are a few orders of the output's turn, where a rest follows that turn and is no order of it: a step
    at one angle, or a sector, is drawn by them as well as so few can, and what is left is the same thing's."""
    follows = rest.coordinate == "load_angle" and rest.order is None and rest.channel in ALONG_THE_OUTPUT
    return {ALONG_THE_OUTPUT[rest.channel]} if follows else set()


def _lives(where: Sequence[Home]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(h.coordinate for h in where if h.share > SOME))[:3]


def _settled(asked: Asked, names: tuple[str, ...], before: float, after: float) -> Conclusion:
    """Nothing loud remains; `before` and `after` are what the worst channel has left, in floors."""
    p = asked.p
    if not names:
        read = [c for c in WHOLE if any(key[1] == c for key in p.held_out.floors)]
        sentence = nothing(read, after, see_little(p.campaign.runs))
        return Conclusion(Verdict(Status.NOTHING, (), (), None, None, None, sentence), None, (), None)
    rivals, next_run = deciding(p, names, asked.found)
    if twins := inseparable(names, read_by_any(p.eq.runs)):
        rivals, next_run = (
            (*rivals, *(twin for twin in twins if twin not in rivals)),
            next_run or by_table({*names, *twins}),
        )
    sentence = lacks(names, before, after)
    if after > QUIETER * before:  # another one than they act on is the worst
        sentence = lacks(names, *most(p.held_out, asked.before, asked.after), "most improved")
    if all(name in p.own.made and not p.own.made[name].keys() & p.held_out.floors.keys() for name in names):
        sentence = f"The model lacks {in_words(names)}: fitted runs show it, held-out ones have none of it."
    elif p.eq.runs[0].look.zeros and after > QUIETER * before:
        sentence = f"The model lacks {in_words(names)}: the zeros of runs lie on one line over their speed."
    if rivals:
        sentence = f"{sentence} These data fit as well with {', '.join(rivals)}."
    status = Status.AMBIGUOUS if rivals else Status.EXPLAINED
    return Conclusion(Verdict(status, names, rivals, None, None, None, sentence), None, (), next_run)
