"""Who looks on at a session: told of events as they happen, and of every run, the proofs among them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rig.core.procedure import Procedure
from rig.loop import Ending
from rig.session.done import Watch, nobody
from rig.timing.ticks import LoopTiming


@dataclass(frozen=True)
class Begun:
    """A run whose recorder is ready and whose first tick is near."""

    folder: Path
    procedure: Procedure
    duration: float  # s it announced
    ring: Path  # where its rows can be read as they come
    timing: LoopTiming


class Observer:
    """Looks away. Called in the thread of the loop: whoever overrides is quick."""

    def simulated(self, bench: str) -> None:
        """The bench of this name has real drivers, and a device says that it is the twin's."""

    def event(self, kind: str, text: str, t: float | None) -> None:
        """As it goes into `events.jsonl`; `t` s since the run's start, None outside of one."""

    def warned(self, text: str) -> None:
        """Of something about the rig that whoever is near has to know before it is energised."""

    def begun(self, run: Begun) -> Watch:
        """A run is about to start; what is returned is shown a sample every 100 ticks, beside the run's own watch."""
        return nobody

    def tripped(self, why: str, t: float | None) -> None:
        """Torque off is commanded, and not yet confirmed: whoever has to know at once is told. The event of the trip
        follows, with what the drive said; `t` as for that."""

    def ended(self, folder: Path, ending: Ending) -> None:
        """Torque is off, the folder is about to be closed."""
