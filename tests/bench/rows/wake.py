"""Row 1: is the loop on time."""

from __future__ import annotations

from contextlib import AbstractContextManager, nullcontext
from typing import ClassVar, final

from rig.core.errors import HdrigError
from rig.session.observer import Observer
from tests.bench.built import Unavailable
from tests.bench.figure import AtMost, Figure, Shown, not_measured, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds
from tests.bench.wake import Loaded, Wake, floor, ours

RATES = (1000, 2000, 4000)  # Hz
MOST = 5  # rounds: a minute for each of the six conditions


@final
class WakeUp(Row):
    """Loaded: a live view of the run and a busy process per core; recorder and its syncs are in every run.

    The console is not running beside it here; tests/studies/console_lateness.py puts it there.
    """

    number: ClassVar[int] = 1
    name: ClassVar[str] = "wake-up of the control process at 1, 2, 4 kHz, idle and loaded"
    against: ClassVar[str] = "C clock_nanosleep FIFO loop in the same run"

    def measure(self, rounds: Rounds) -> list[Figure]:
        return [*self._under("idle", nullcontext(Observer()), rounds), *self._under("loaded", Loaded(), rounds)]

    def _under(self, words: str, load: AbstractContextManager[Observer], rounds: Rounds) -> list[Figure]:
        """All rates under one load; what cannot be had under it says so and does not take the other with it."""
        figures: list[Figure] = []
        try:
            with load as looking_on:
                for rate in RATES:
                    figures += self._rate(rate, looking_on, words, rounds)
        except (Unavailable, HdrigError) as why:
            figures.append(not_measured(f"{words}: from here on", Shown(), str(why)))
        return figures

    def _rate(self, rate: int, looking_on: Observer, words: str, rounds: Rounds) -> list[Figure]:
        mine: list[Wake] = []
        theirs: list[Wake] = []
        seconds = rounds.size(2, 1)
        for _ in range(min(rounds.count, MOST)):
            theirs.append(floor(rate, seconds))
            mine.append(ours(rate, seconds, looking_on))
        points = [100.0 * (a.missed - b.missed) for a, b in zip(mine, theirs, strict=True)]
        name = f"{rate / 1000:g} kHz, {words}"
        return [
            ratio(f"{name}: p50", [w.p50 for w in mine], [w.p50 for w in theirs], AtMost(1.2)),
            ratio(f"{name}: p99", [w.p99 for w in mine], [w.p99 for w in theirs], AtMost(1.5)),
            Figure(f"{name}: cycles missed beyond the floor's", points, AtMost(0.1), "points"),
        ]
