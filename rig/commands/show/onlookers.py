"""Several who look on at one session."""

from __future__ import annotations

from pathlib import Path
from typing import final

from rig.core.sample import Sample
from rig.loop import Ending
from rig.session.done import Watch
from rig.session.observer import Begun, Observer


@final
class Onlookers(Observer):
    """Each is told in turn."""

    def __init__(self, *each: Observer) -> None:
        self._each = each

    def simulated(self, bench: str) -> None:
        for one in self._each:
            one.simulated(bench)

    def warned(self, text: str) -> None:
        for one in self._each:
            one.warned(text)

    def event(self, kind: str, text: str, t: float | None) -> None:
        for one in self._each:
            one.event(kind, text, t)

    def begun(self, run: Begun) -> Watch:
        watches = [one.begun(run) for one in self._each]

        def watch(sample: Sample) -> None:
            for one in watches:
                one(sample)

        return watch

    def tripped(self, why: str, t: float | None) -> None:
        for one in self._each:
            one.tripped(why, t)

    def ended(self, folder: Path, ending: Ending) -> None:
        for one in self._each:
            one.ended(folder, ending)
