"""A search and its selection: which effects the data want beside the baseline, once over what is prepared."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

from rig.analysis.tracing.fit.bank import Bank, fill, reach, torque_noise
from rig.analysis.tracing.fit.encoder_lines import with_lines
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.learnt import change
from rig.analysis.tracing.fit.model import Solution, design, fit
from rig.analysis.tracing.fit.refine import refine
from rig.analysis.tracing.fit.search import Found, relawed, settled, still
from rig.analysis.tracing.fit.some import search_some, some
from rig.analysis.tracing.floor.noise import measure, quieter
from rig.analysis.tracing.floor.own import find
from rig.analysis.tracing.floor.steps import LOST
from rig.analysis.tracing.floor.vibration import VIBRATION
from rig.analysis.tracing.prepared import Prepared, built
from rig.analysis.tracing.selection.certain import is_calm, is_calm_there, is_certain
from rig.analysis.tracing.selection.confounders import CONFOUNDERS, of_the_library
from rig.analysis.tracing.selection.further import select_further
from rig.analysis.tracing.selection.named_instead import named_instead
from rig.analysis.tracing.selection.select import select
from rig.analysis.tracing.selection.selected import Selected
from rig.model.effect import Reach
from rig.model.effects import CATALOGUE
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift
from rig.process.workers import give_back

DRIFT: Final = ThermalFrictionDrift.name
WARMS: Final = 30.0  # nats, of friction that warms: with less it is not asked for below the floor
SCATTERS: Final = 0.5  # of the floor, how far friction lies apart from run to run, RMS: clean rigs have a tenth
OTHER: Final = 0.05  # relative, of the gear: an inertia that ran away had gone by 0.15


def searched(
    p: Prepared, wanted: frozenset[str] = frozenset(), shown: Callable[[Selected], bool] | None = None
) -> tuple[Selected, Found]:
    """What stands of all that was searched for, and the candidates of the library. Where only some names are `wanted`,
    and the search brings none of them, or what is looked for is not `shown` by what stands, nobody asks for what else
    might stand: that takes minutes."""
    runs = p.split.fitted
    covered = replace(reach([p.eq.runs[i] for i in runs]), torque_noise=torque_noise(p.eq))
    start = fit(design(p.eq, (), runs))
    quiet = still(start, p.floors)
    tried = Tried(p, with_lines(covered, start, runs))
    calm = quiet or is_calm(p)
    selected, found, covered = _selected(p, start, tried, quiet, calm, wanted, shown)
    if (calm and not is_certain(selected, p.held_out)) or is_calm_there(p, selected):
        found = Found(start, found.ranking)
        selected = select(p, found, runs, covered)
    del tried  # half a gigabyte, and the report is made by two processes
    give_back()
    return selected, replace(found, ranking=of_the_library(found.ranking))


class Tried:
    """All that is tried, in shapes that what the runs cover can show. A bank is a gigabyte where no torque was read, so
    that there is only ever one."""

    def __init__(self, p: Prepared, covered: Reach) -> None:
        self.fill(p, covered)

    def fill(self, p: Prepared, covered: Reach) -> None:
        """Made anew; the one before is gone first. What hundreds of shapes keep with the signals they are made of is a
        tenth of a gigabyte, and done with."""
        vars(self).pop("bank", None)
        give_back()
        candidates = [
            *CATALOGUE.values(),
            *(confounder.effect for confounder in CONFOUNDERS.values() if confounder.searched),
        ]
        self.covered = covered
        self.bank: Bank = fill(some(p.eq.afresh(), p.split.fitted), candidates, p.split.fitted, covered)


def _selected(
    p: Prepared,
    start: Solution,
    tried: Tried,
    quiet: bool,
    calm: bool,
    wanted: frozenset[str],
    shown: Callable[[Selected], bool] | None,
    but: frozenset[str] = frozenset(),
) -> tuple[Selected, Found, Reach]:
    """What stands of a search through all `but` some effects, what it found, and what is covered by then."""
    runs = p.split.fitted
    without = but | p.own.made.keys()
    found = search_some(start.design, tried.bank, runs, tried.covered, p.silence, quiet=quiet, excluded=without)
    give_back()
    let_go = bool(_remembering(found.solution.design.terms))
    again, found = _again(p, found, tried, but)
    give_back()
    covered = tried.covered
    selected = select(replace(again, held_out=replace(again.held_out, calm=calm)), found, runs, covered)
    selected = _own_as_it_stands(selected, found, runs, covered)
    if alone := _at_the_floor_alone(p, again, selected, start, covered, calm):
        return alone, Found(start, found.ranking), covered
    if warmer := _warmer(selected, found, runs, covered):
        return warmer, found, covered
    asked = (not wanted or not wanted.isdisjoint(found.names)) and (shown is None or shown(selected))
    if asked and (not quiet or selected.loud):  # friction of one speed is told by all runs, under the floor of each
        selected = select_further(selected, found, tried.bank, runs, covered)
    selected = named_instead(selected, found, tried.bank, runs, covered)
    if let_go and not _remembering(selected.solution.design.terms):
        # zeros were let go for nothing, and with them a run's mean torque told nothing of its mean wind-up
        other = _selected(p, start, tried, quiet, calm, wanted, shown, _remembering(tried.bank.terms))
        return other if _is_better(other[0], selected) else (selected, found, covered)
    return selected, found, covered


def _warmer(selected: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected | None:
    """With friction that warms beside what explains everything above the floor: repeats on another day differ by it, so
    that it is in the floor of the motor's torque, and never above it. It counts where it is as certain as it would have
    to be by itself."""
    drift = next((r for r in found.ranking if r.term.name == DRIFT and r.evidence > WARMS), None)
    measured = selected.p.measured
    scatters = measured.friction.square > (SCATTERS * measured.noise.sigma["M"]) ** 2
    if not scatters or drift is None or selected.loud or not selected.names:
        return None
    if DRIFT in selected.names | selected.taken:
        return None
    s = settled(refine(selected.solution.design, drift.term, runs, covered)[1], runs, covered)
    again, s = beside(selected.p, s, covered)
    again = replace(again, held_out=replace(again.held_out, calm=True))
    other = select(again, replace(found, solution=s), runs, covered)
    certain = other.names == {DRIFT, *selected.names} and is_certain(other, selected.p.held_out)
    return other if certain else None


def _is_better(other: Selected, selected: Selected) -> bool:
    """Whether another selection leaves nothing loud where this one does; of two alike, less, or has all its names."""
    if other.loud:
        return selected.loud and selected.names < other.names and other.left < selected.left
    return selected.loud or selected.names <= other.names or other.left < selected.left


def _at_the_floor_alone(
    p: Prepared, again: Prepared, selected: Selected, start: Solution, covered: Reach, calm: bool
) -> Selected | None:
    """The baseline, where it leaves nothing by itself and no effect stands that was found beside it: the equations lean
    on what those had made of the gear by then, and it goes with them."""
    if not selected.loud or selected.names or selected.taken:
        return None
    before, now = (one.eq.runs[0].gear for one in (p, again))
    if change(before, now) <= OTHER:
        return None
    alone = select(replace(p, held_out=replace(p.held_out, calm=calm)), Found(start, ()), p.split.fitted, covered)
    return None if alone.loud else alone


def _own_as_it_stands(selected: Selected, found: Found, runs: Sequence[int], covered: Reach) -> Selected:
    """Selected again where what runs have to themselves was taken for another thing beside effects that do not stand: a
    line for a vibration of the load, which beside what stands may be one sensor's own; or a jump for counts that are
    lost on and on, which are looked for by no step."""
    stands, tried = selected.solution.design.terms, found.solution.design.terms
    on_and_on = LOST.name in {term.name for term in tried} - {term.name for term in stands}
    if len(stands) == len(tried) or not (VIBRATION.name in selected.p.own.made or on_and_on):
        return selected
    again, s = beside(selected.p, selected.solution, covered)
    if again.own.made.keys() == selected.p.own.made.keys() and again.own.jumped == selected.p.own.jumped:
        return selected
    again = replace(again, held_out=replace(again.held_out, calm=selected.p.held_out.calm))
    return select(again, replace(found, solution=s), runs, covered)


def _remembering(terms: Sequence[Term]) -> frozenset[str]:
    """Effects that remember: their state when a run begins is unknown, and its zero free beside them."""
    return frozenset(term.name for term in terms if term.effect.remembers)


def _again(p: Prepared, found: Found, tried: Tried, but: frozenset[str]) -> tuple[Prepared, Found]:
    """What each run has to itself and the floor, looked for beside the effects that were found, and what they uncover.

    A large effect in the model's want hides lost counts, looks like them, and makes repeats differ. A weight that
    nobody declared is most of the torque that others go by: then all that is `tried` is made anew.
    """
    if not found.solution.design.terms:
        return p, found
    again, s = beside(p, found.solution, tried.covered, found.rough)
    runs = p.split.fitted
    if any(run.carries for run in again.eq.runs):
        loaded = reach([again.eq.runs[i] for i in runs])
        tried.fill(again, replace(tried.covered, torque=loaded.torque, pulled=loaded.pulled))
    how = {"ranking": found.ranking, "excluded": but | again.own.made.keys()}
    found = search_some(s.design, tried.bank, runs, tried.covered, again.silence, **how)
    return again, found


def beside(p: Prepared, s: Solution, covered: Reach, rough: bool = False) -> tuple[Prepared, Solution]:
    """Prepared anew beside effects that were found, and they fitted to that. What a `rough` search found was fitted to
    all rows just now."""
    runs = p.split.fitted
    eq = s.design.eq
    free = s if not eq.own else replace(s, design=design(replace(eq, own={}), s.design.terms, runs))
    own = p.own if p.own.many else find(free, p.split)
    columns = own.columns()
    same = rough and not eq.own and not columns
    with_own = s if same else fit(design(replace(eq, own=columns), s.design.terms, runs))
    measured = quieter(p.measured, measure(with_own, runs))
    if _remembering(s.design.terms):
        measured = replace(measured, noise=measured.noise.free("A"))
    again = replace(built(p.campaign, p.split, eq, measured, own), first=p.first)
    return again, relawed(fit(design(again.eq, s.design.terms, runs)), runs, covered)
