"""Who is at the rig while a verb works on it: signals, keys, the person who is asked."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from rig.commands.person import Person
from rig.commands.show.keys import Keys
from rig.commands.show.show import Show
from rig.process.interrupts import Interrupts


@contextlib.contextmanager
def at_the_rig(show: Show) -> Iterator[tuple[Interrupts, Person]]:
    """Signals and keys ask the interrupts; a question to the person has the terminal for itself meanwhile."""
    with Interrupts() as interrupts, Keys(interrupts, lambda: show.energised) as keys:
        yield interrupts, Person(interrupts, show.prompt, keys.paused)
