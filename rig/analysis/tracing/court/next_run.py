"""Rivals of a named effect, and the run that would decide between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Final

import numpy as np

from rig.analysis.tracing.court.expected import TWICE, Proposal, imagined, proposals, sigmas
from rig.analysis.tracing.court.judge import unseen
from rig.analysis.tracing.fit.bank import reach
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.refine import nudged, refine
from rig.analysis.tracing.fit.search import Found, Scored, possible
from rig.analysis.tracing.outcome.result import NextRun
from rig.analysis.tracing.runs.holdout import split
from rig.analysis.tracing.thresholds import CLOSE, QUIET, STILL_RUN
from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared


SIGMAS: Final = 3.0  # standard deviations, at least
EDGE: Final = 0.02  # of a bound: a shape that near was pushed there, and cannot give way on
HALF: Final = 0.5  # of the evidence, in the bank's coarse shapes: with less no refit catches up


def deciding(p: Prepared, names: Sequence[str], found: Found) -> tuple[tuple[str, ...], NextRun | None]:
    """Effects that alone would have done as well as the first one named, and the cheapest run that tells them apart."""
    best = next((r for r in found.ranking if r.term.name == names[0]), None)
    if best is None or len(names) > 1:
        return (), None
    others = [r for r in found.ranking if r.term.name not in names]
    close = [r for r in others if r.evidence > CLOSE * best.evidence or _as_good(p, r, best)]
    rivals = tuple(r.term.name for r in close)
    if not rivals:
        return (), None
    asked = _by_information(p, best, close)
    return rivals, asked or _by_table({names[0], *rivals})


def _as_good(p: Prepared, rival: Scored, best: Scored) -> bool:
    """Whether a rival far behind in the bank's shape explains everything alone once its shape is fitted."""
    if rival.evidence < HALF * best.evidence:
        return False
    s = _refined(p, rival.term)
    term, covered = s.design.terms[0], reach([p.eq.runs[i] for i in p.split.fitted])
    if term.effect.beyond(term.shape, covered) or not possible(s, term, s.x[s.design.place(0)]):
        return False
    total, single = p.court.worst(p.court.residuals(s, unseen(s, p.court)))
    return total < QUIET and single < STILL_RUN


def _refined(p: Prepared, term: Term) -> Solution:
    """The term alone beside the baseline, in the shape that fits best."""
    runs = p.split.fitted
    return refine(p.baseline.design, term, runs, reach([p.eq.runs[i] for i in runs]))[1]


@dataclass(frozen=True)
class Yielding(Effect):
    """An effect whose shape gives way: its columns, and their change with each shape parameter that is fitted. A rival
    is not what it was fitted as to the runs there are, but whatever it can become on those and one more.
    """

    of: Effect
    slopes: tuple[Effect, ...]

    name: ClassVar[str] = "yielding"
    in_short: ClassVar[str] = "an effect and its change with its shape"
    source: ClassVar[str] = "fuller1987"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """None of its own."""
        return ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Those of the effect, then one of each slope, at every port of the effect."""
        made, more = self.of.columns(signals, shape), [slope.columns(signals, shape) for slope in self.slopes]
        return {port: np.concatenate([own, *(slope[port] for slope in more)], axis=1) for port, own in made.items()}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """None."""
        return ()


def _yielding(s: Solution, covered: Reach) -> Term:
    """The last term of a fit, free in its shape as well but for what was pushed to a bound."""
    term, c = s.design.terms[-1], s.x[s.design.place(len(s.design.terms) - 1)]
    slopes = [
        nudged(term, i, c).effect
        for i, (low, high) in enumerate(term.effect.bounds(covered))
        if term.effect.loose[i] and low * (1 + EDGE) < term.shape[i] < high * (1 - EDGE)
    ]
    return Term(Yielding(term.effect, tuple(slopes)), term.shape) if slopes else term


def _by_information(p: Prepared, best: Scored, close: Sequence[Scored]) -> NextRun | None:
    """The cheapest run of the catalogue that is expected to make every rival's evidence fall behind; where none is, the
    one that tells most, and None when that is nothing to speak of.

    A rival is one while it has CLOSE of the best one's evidence: what the run tells, in nats, has to be more than that.
    """
    dt = p.eq.runs[0].pieces[0].dt
    proposed = proposals(dt)
    need = max(SIGMAS, float(np.sqrt(2 * (1 - CLOSE) * best.evidence)))
    told = np.full(len(proposed), np.inf)
    one, covered = _refined(p, best.term), reach([p.eq.runs[i] for i in p.split.fitted])
    for other in (_refined(p, r.term) for r in close):
        for f, g in ((one, other), (other, one)):
            apart = sigmas(p.baseline, f.design.terms[-1], _yielding(g, covered), p.split.fitted, proposed)
            told = np.minimum(told, apart)
    told = told * np.sqrt([_fitted(p, run) for run in proposed])
    cost = [run.cost(dt) for run in proposed]
    able = [i for i in range(len(proposed)) if told[i] > need]
    first = min(able, key=lambda i: (cost[i], -told[i])) if able else int(np.argmax(told))
    if told[first] < SIGMAS:
        return None
    names = " from ".join(sorted({best.term.name, *(r.term.name for r in close)}))
    how = f"the cheapest of {len(able)} runs that would" if able else "most of all runs, and perhaps not enough"
    because = (
        f"separates {names} by {told[first]:.0f} standard deviations expected ({need:.0f} are needed), {how}: "
        f"{cost[first]:.0f} s of rig time with its repeat"
    )
    return NextRun(proposed[first].procedure, dict(proposed[first].conditions), because)


def _fitted(p: Prepared, proposal: Proposal) -> float:
    """Share of the run and its repeat that the next trace would fit: a speed or load between others is held out whole,
    and of most pairs one of the two.
    """
    runs = p.campaign.runs
    like = next(p.eq.runs[i] for i in p.split.fitted)
    made = imagined(proposal, like, p.baseline, max(float(run.pieces[-1].t[-1]) for run in runs))
    again = split((*runs, *(replace(made, name=f"{made.name} {k + 1}") for k in range(TWICE))), ())
    return sum(len(runs) + k in again.fitted for k in range(TWICE)) / TWICE


def _by_table(pair: set[str]) -> NextRun:
    """What is known to separate some effects where no run of the catalogue is expected to by its numbers."""
    for members, procedure, conditions, why in DECIDERS:
        if len(members & pair) >= 2:
            return NextRun(procedure, conditions, f"separates {' from '.join(sorted(pair))}: {why}")
    return NextRun("constant_torque", {"speed_rpm": 500.0}, f"separates {' from '.join(sorted(pair))} by speed")


DECIDERS: Sequence[tuple[frozenset[str], str, dict[str, float | bool | str], str]] = (
    (
        frozenset({"thermal_friction_drift", "quadratic_drag", "stribeck_friction"}),
        "friction",
        {"speeds_rpm": "15,30,60,120,200,310,400,500", "output_deg": 4.0, "breakaways": 1},
        "every speed from creep to fast within three minutes, rising and falling: at two or three speeds, minutes "
        "apart, falling friction, drag and warming bend the same curve",
    ),
    (
        frozenset({"nonlinear_stiffness", "hysteretic_stiffness", "lost_motion"}),
        "stiffness_lock",
        {"output_locked": True},
        "nested amplitudes show whether the branches meet",
    ),
    (
        frozenset({"output_once_per_rev", "torque_sensor_crosstalk", "gravity_unbalance"}),
        "constant_torque",
        {"speed_rpm": 400.0},
        "a real angle error makes torque when it turns fast",
    ),
)
