"""Plain lines, where nobody looks at a terminal: what is said, trips, acts of the operator, a line a tenth of a run."""

from __future__ import annotations

from typing import Any, TextIO, final

from rig.commands.show.screens import Screen
from rig.commands.show.words import late, peak


@final
class Lines(Screen):
    """Nothing is ever drawn over."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__(stream)
        self._title, self._duration, self._tenth = "", 0.0, 0

    def take(self, event: dict[str, Any]) -> None:
        """One event as a line or none; of progress ten lines a run."""
        match event["event"]:
            case "bench" if event["simulated"]:
                self.write(f"SIMULATED: bench '{event['bench']}' is the twin, {event['clock']} clock\n")
            case "said" | "simulated" | "prompt":  # a figure is printed on stdout
                self.write(f"{event['text']}\n")
            case "trip" | "operator":
                self.write(f"{event['text']}\n")
            case "run":
                self._title, self._duration, self._tenth = event["title"], event["duration_s"], 0
                self.write(f"{self._title}: at most {self._duration:.0f} s of rig time\n")
            case "progress":
                self._progress(event)

    def close(self) -> None:
        """Nothing is left over: every line was written whole."""
        return

    def _progress(self, event: dict[str, Any]) -> None:
        t = event["t"]
        tenth = int(10 * t / self._duration) if self._duration > 0 else 0
        if tenth > self._tenth:
            self._tenth = tenth
            self.write(
                f"{self._title} {event['state']}: {t:6.1f} of {self._duration:.1f} s, {peak(event)}, {late(event)}\n"
            )
