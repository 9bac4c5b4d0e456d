"""What every run shows in its own way: found in what a fit leaves of the fitted runs, given to all runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.fit.model import Solution, design
from rig.analysis.tracing.floor.between_runs import find_between
from rig.analysis.tracing.floor.interference import Interference, find_interference
from rig.analysis.tracing.floor.local import joined
from rig.analysis.tracing.floor.once_under_load import OnceUnderLoad, once_under_load
from rig.analysis.tracing.floor.own_beats import own_beats
from rig.analysis.tracing.floor.own_delays import SKEW, own_delays
from rig.analysis.tracing.floor.ringing import ringing
from rig.analysis.tracing.floor.scratched import scratched
from rig.analysis.tracing.floor.shaken_load import shaken_load
from rig.analysis.tracing.floor.shaken_motor import shaken_motor
from rig.analysis.tracing.floor.sidebands import sidebands
from rig.analysis.tracing.floor.stairs import stairs
from rig.analysis.tracing.floor.steps import (
    LOST,
    Steps,
    explained,
    find_steps,
    lost_counts,
    placed,
    square_taken,
    step_columns,
)
from rig.analysis.tracing.floor.vibration import VIBRATION, find_vibration
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.runs.holdout import HELD_PART, Split
from rig.analysis.tracing.thresholds import OWN
from rig.model.effect import Array, Parameter

HALF: Final = 0.5  # of the sum of squares that runs with steps leave


@dataclass(frozen=True)
class Own:
    """Columns (n, q) by effect and block, the effects' parameters, a line beside the motion that is no effect of the
    library, notes on effects in a sentence each, columns of what is no effect but how a run began or that it jumped
    under load, and that jump. `many`: counts are lost again and again, by which an effect may seem to be there."""

    made: dict[str, dict[Key, Array]]
    parameters: dict[str, tuple[Parameter, ...]]
    line: Interference | None
    notes: Mapping[str, str] = field(default_factory=dict)
    nameless: Mapping[Key, Array] = field(default_factory=dict)
    jumped: OnceUnderLoad | None = None
    many: bool = False

    def columns(self) -> dict[Key, Array]:
        """Of all effects together, of the line and of what has no name."""
        return joined([*self.made.values(), *([self.line.columns] if self.line else []), self.nameless])

    def without(self, names: Sequence[str]) -> Own:
        """The others."""
        made = {name: columns for name, columns in self.made.items() if name not in names}
        parameters = {name: self.parameters[name] for name in made}
        return replace(self, made=made, parameters=parameters, many=self.many and LOST.name in made)


def find(s: Solution, parts: Split) -> Own:
    """In the residuals of `s`, a fit to the fitted runs without columns of their own."""
    eq, e = s.design.eq, {key: s.residual(key) for key in s.keys}
    held = design(replace(eq, noisy={}), s.design.terms, parts.held_out)
    # counts are lost in one run or another: what a held-out run shows of it no fit to others foretells
    everywhere = e | {key: held.residual(key, s.x) for key in held.y}
    own = _shaken(s, e, everywhere, parts)
    runs = sorted({i for i, _ in everywhere})
    own = replace(own, nameless=ringing(eq, s.design.terms, runs))
    whole = [i for i in runs if (i, "A") in everywhere and HELD_PART not in eq.runs[i].name]
    again = any(term.name == LOST.name for term in s.design.terms)  # again and again, by one law for all runs
    steps = None if again else find_steps(eq, everywhere, s.value("compliance"))
    # jumps come first: what they shift single runs by looks like delays, and no delay makes any
    stepping = None if steps is None else _stepping(eq, everywhere, own, steps, whole)
    if not again and (rows := stairs(eq, everywhere)):
        many = _stepping(eq, everywhere, replace(own, many=True), placed(eq, everywhere, rows), whole)
        stepping = _that_takes_more(everywhere, many, stepping)
    if stepping is not None:
        return stepping
    if not _is_late(s.design.terms):
        late = own_beats(eq, everywhere, whole, runs) or own_delays(s, whole, runs)
        if late is not None:
            return _with(own, SKEW.name, late.columns, late.parameters(), late.sentence())
    if steps is None or steps.rows or (between := find_between(s, whole)) is None:
        return own
    return _with(own, LOST.name, between.columns(eq), between.parameters(), between.sentence(eq))


def _is_late(terms: Sequence[Term]) -> bool:
    """Whether a delay of one law for all runs is among them."""
    return any(term.name == SKEW.name for term in terms)


def _shaken(s: Solution, e: Mapping[Key, Array], everywhere: Mapping[Key, Array], parts: Split) -> Own:
    """A vibration of the load or of the motor, or a line that is none."""
    eq, nothing = s.design.eq, Own({}, {}, None)
    if any("t" not in eq.runs[i].has for i in parts.fitted):  # nothing has a frequency
        return nothing
    if (steady := find_vibration(s, e, parts.fitted)) is not None:
        beside = sidebands(eq, everywhere, [line.frequency_hz for line in steady.lines])
        return _with(nothing, VIBRATION.name, joined([steady.columns, beside]), steady.parameters())
    line = find_interference(eq, e, {key: x for key, x in everywhere.items() if key not in e})
    if line is not None and (found := shaken_motor(s, line) or shaken_load(s, line)) is not None:
        return _with(nothing, VIBRATION.name, line.columns, found.parameters(), found.said)
    return replace(nothing, line=line)


def _stepping(
    eq: Equations, everywhere: Mapping[Key, Array], own: Own, steps: Steps, whole: Sequence[int]
) -> Own | None:
    """With counts that were lost within runs, anywhere or at one place, or a jump that may be the gear's; None where
    the steps are none of these, by the repeats among runs `whole`."""
    if not lost_counts(eq, steps, repeats(eq.runs, whole)):
        if (lost := scratched(eq, everywhere, steps)) is None:
            return None
        steps = lost
    columns = step_columns(eq, steps)
    if explained(eq, everywhere, columns) <= OWN:
        return None
    if (jumped := once_under_load(eq, everywhere, steps)) is not None:
        return replace(own, nameless=joined([own.nameless, columns]), jumped=jumped)
    return _with(own, LOST.name, columns, steps.parameters())


def _that_takes_more(everywhere: Mapping[Key, Array], many: Own | None, few: Own | None) -> Own | None:
    """Stairs where they leave half of what the steps that stand out one by one do, which have fewer numbers."""
    if many is None or few is None:
        return many or few
    made = [own.made.get(LOST.name, {}) for own in (many, few)]
    angles = [everywhere[key] for key in {*made[0], *made[1]} if key[1] == "A"]
    all_of_it = sum(float(np.sum((e - e.mean()) ** 2)) for e in angles)
    left = [all_of_it - sum(square_taken(everywhere, columns).values()) for columns in made]
    return many if left[0] < HALF * left[1] else few


def _with(own: Own, name: str, columns: dict[Key, Array], words: tuple[Parameter, ...], note: str = "") -> Own:
    """And an effect more."""
    notes = {**own.notes, name: note} if note else own.notes
    made, parameters = {**own.made, name: columns}, {**own.parameters, name: words}
    return replace(own, made=made, parameters=parameters, notes=notes)
