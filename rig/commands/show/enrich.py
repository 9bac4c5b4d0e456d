"""What the ring of a run says, added to its progress: peak to peak from every sample, not from those the loop shows."""

from __future__ import annotations

from pathlib import Path
from typing import Any, final

from rig.commands.show.screens import Screen
from rig.core.errors import HdrigError
from rig.supervisor import State


@final
class Enriched:
    """In front of a screen: knows the state the rig is in, and reads along in the ring of the run."""

    def __init__(self, screen: Screen) -> None:
        self._screen = screen
        self._ratio = 1.0
        self._state = ""
        self._tail: Any = None
        self._so_far: Any = None
        self._rows = 0

    def take(self, event: dict[str, Any]) -> None:
        """One event, with what is known beside it."""
        match event["event"]:
            case "bench":
                self._ratio = event["ratio"]
            case "state" | "operator" | "trip":
                self._state = _state_in(str(event["text"])) or self._state
            case "run":
                self._begin(Path(event["ring"]))
            case "progress":
                event = {**event, "state": self._state, **self._seen()}
            case "ended":
                event = {**event, **self._seen()}
                self._end()
        self._screen.take(event)

    def close(self) -> None:
        """No event follows."""
        self._end()
        self._screen.close()

    def _begin(self, ring: Path) -> None:
        from rig.console.sofar import SoFar
        from rig.live.tail import Tail

        self._end()
        self._rows = 0
        try:
            self._tail, self._so_far = Tail(ring), SoFar(self._ratio)
        except (HdrigError, OSError):  # a run that is over already
            self._tail = None

    def _seen(self) -> dict[str, Any]:
        if self._tail is None:
            return {"peak_to_peak_arcsec": None, "rows": None, "skipped": None}
        rows = self._tail.read()
        self._rows += len(rows)
        self._so_far.add(rows)
        return {
            "peak_to_peak_arcsec": self._so_far.peak_to_peak,
            "rows": self._rows + self._tail.skipped,
            "skipped": self._tail.skipped,
        }

    def _end(self) -> None:
        if self._tail is not None:
            self._tail.close()
            self._tail = None


def _state_in(text: str) -> str:
    """The state that an event begins with; "" where it begins otherwise, as that of a halt does."""
    word = text.partition(":")[0]
    return word if word in set(State) else ""
