"""Who is at the rig while a verb works on it: signals, keys, the person who is asked."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import final

from rig.commands.person import Person
from rig.commands.show.keys import Keys
from rig.commands.show.show import Show
from rig.loop import Ending
from rig.process.interrupts import Interrupts
from rig.session.done import Watch, nobody
from rig.session.observer import Begun, Observer


@final
class Energised(Observer):
    """Whether a run goes on: between its start and its end there may be torque."""

    def __init__(self) -> None:
        self.now = False

    def begun(self, run: Begun) -> Watch:
        self.now = True
        return nobody

    def ended(self, folder: Path, ending: Ending) -> None:
        self.now = False


@contextlib.contextmanager
def at_the_keys() -> Iterator[tuple[Interrupts, Person, Observer]]:
    """As `at_the_rig`, of a verb that shows nothing but its own words; the observer is for its session."""
    seen = Energised()
    with Interrupts() as interrupts, Keys(interrupts, lambda: seen.now) as keys:
        yield interrupts, Person(interrupts, quiet=keys.paused), seen


@contextlib.contextmanager
def at_the_rig(show: Show) -> Iterator[tuple[Interrupts, Person]]:
    """Signals and keys ask the interrupts; a question to the person has the terminal for itself meanwhile."""
    with Interrupts() as interrupts, Keys(interrupts, lambda: show.energised) as keys:
        yield interrupts, Person(interrupts, show.prompt, keys.paused)
