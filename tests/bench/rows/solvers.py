"""Row 5: the plant beside library solvers at equal accuracy."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar, final

import numpy as np

from rig.analysis.findings.result import Array
from tests.bench.built import Unavailable
from tests.bench.figure import AtMost, Figure, not_measured, ratio
from tests.bench.row import Row
from tests.bench.slow_run import SlowRun
from tests.bench.turns import Rounds, Side, cpu, take_turns
from tests.bench.worker import Worker

SPEED = 10.0  # rad/s: 95 rpm, both sides slide forward all the time, which is all that the peers can follow
EQUAL = 1e-9  # rad RMS of θ̃
STIFFER = (1.0, 4.0, 16.0)  # times K
REFINE = (1.0, 2.0, 4.0, 8.0)  # of our substeps
TOLERANCES = (1e-6, 1e-8, 1e-10, 1e-12)
SOLVERS = ("diffrax", "scikit-sundae")
TRUTH = 256  # steps of the C floor a tick: its fourth order is then far below 1e-12 rad
REPEATS = 20  # of our side: one lasts a millisecond


@final
class Solvers(Row):
    """Each solver at the loosest setting that reaches 1e-9 rad, restarted at every tick of 1 ms with a new torque.

    numbalsoda, the fastest peer known, needs a Fortran compiler to be installed. Sticking is in our figures of accuracy
    (row 4: a slow run with its reversals) and in no peer's: none of them has a side that stands still.
    """

    number: ClassVar[int] = 5
    name: ClassVar[str] = "plant at equal accuracy (1e-9 rad) in three stiffness cases"
    against: ClassVar[str] = "best of diffrax and scikit-sundae; numbalsoda"

    def measure(self, rounds: Rounds) -> list[Figure]:
        figures = []
        ticks = rounds.size(1000, 100)
        for times in STIFFER:
            figures += self._case(f"{times:g} K", SlowRun.steady(ticks, SPEED, times), rounds)
        return [*figures, not_measured("over numbalsoda", AtMost(0.25), "no Fortran compiler here to install it with")]

    def _case(self, words: str, run: SlowRun, rounds: Rounds) -> list[Figure]:
        truth = run.by_floor(sub=TRUTH)()
        ours = next((r for r in finer(run) if apart(r.by_kernel(), truth) <= EQUAL), finer(run)[-1])
        name = f"{words}: error of θ̃ RMS, substeps {ours.refine:g} times finer than chosen by default"
        figures = [Figure(name, [apart(ours.by_kernel(), truth)], AtMost(EQUAL), "rad")]
        return [*figures, *(self._beside(words, solver, ours, truth, rounds) for solver in SOLVERS)]

    def _beside(self, words: str, solver: str, ours: SlowRun, truth: Array, rounds: Rounds) -> Figure:
        name, target = f"{words}: CPU time over {solver}", AtMost(0.25)
        question = ours.question() | {"solver": solver}
        try:
            with Worker("ode") as peer:
                tolerance = loosest(peer, question, truth)
                theirs: Side = lambda: float(peer.ask(**question, tolerance=tolerance)["cpu"])  # noqa: E731
                cost = take_turns({"theirs": theirs, "ours": repeated(ours)}, min(rounds.count, 3))
        except Unavailable as why:
            return not_measured(name, target, str(why))
        return ratio(f"{name} at tolerance {tolerance:g}", cost["ours"], cost["theirs"], target)


def finer(run: SlowRun) -> list[SlowRun]:
    """The same run in ever finer substeps."""
    return [replace(run, refine=refine) for refine in REFINE]


def repeated(run: SlowRun) -> Side:
    """CPU time of one run [s], from many."""

    def many() -> None:
        for _ in range(REPEATS):
            run.by_kernel()

    side = cpu(many)
    return lambda: side() / REPEATS


def apart(a: Array, b: Array) -> float:
    """RMS [rad]; infinite where it is no number."""
    rms = float(np.sqrt(np.mean((a - b) ** 2)))
    return rms if np.isfinite(rms) else float("inf")


def loosest(peer: Worker, question: dict[str, Any], truth: Array) -> float:
    """The first tolerance that reaches the accuracy. Raises Unavailable when none does."""
    offs = []
    for tolerance in TOLERANCES:
        offs.append(apart(np.array(peer.ask(**question, tolerance=tolerance)["error"]), truth))
        if offs[-1] <= EQUAL:
            return tolerance
    raise Unavailable(f"{min(offs):.1e} rad RMS at best")
