"""A terminal: what is said scrolls by, the run stands in a few lines at its foot, and nothing of them stays behind."""

from __future__ import annotations

import os
import textwrap
import time
from collections.abc import Sequence
from typing import Any, TextIO, final

from rig.commands.show.screens import Screen
from rig.commands.show.words import late, peak

KEYS = ("any key: halt (torque off)", "s, Ctrl-Z: stop", "h: hold", "Ctrl-C: stop, twice: halt")  # fit 80 columns
SIGNALS = ("no keys are heard here (standard input is no terminal)", "Ctrl-Z: stop", KEYS[-1])
APART = "  "
BAR = 12  # characters
HOLDING = "holding"  # of the states an event can carry
SETTLED = 1.0  # s to watch before a pace is believed
UP, CLEAR = "\x1b[1A", "\r\x1b[J"  # to the line above; from here to the end of the screen


@final
class Terminal(Screen):
    """Redrawn with every progress event."""

    def __init__(self, stream: TextIO, keyed: bool = True) -> None:
        """`keyed`: keys are heard."""
        super().__init__(stream)
        self._keys = KEYS if keyed else SIGNALS
        self._foot = ""  # what stands there now
        self._run: dict[str, Any] = {}
        self._mark = ""
        self._t, self._first = 0.0, (0.0, 0.0)  # s of the run: now; when it was first seen, and s on the wall

    def take(self, event: dict[str, Any]) -> None:
        """One event: what is said scrolls by, progress redraws the foot."""
        match event["event"]:
            case "bench":
                self._mark = "SIMULATED " if event["simulated"] else ""
                if event["simulated"]:
                    self._say(f"SIMULATED: bench '{event['bench']}' is the twin, {event['clock']} clock")
            case "simulated":
                self._mark = "SIMULATED "
                self._say(event["text"])
            case "said" | "prompt" | "trip" | "operator":  # a figure is printed on stdout
                self._say(event["text"])
            case "run":
                self._run, self._t, self._first = event, 0.0, (0.0, 0.0)
            case "progress" if self._run:
                self._draw(event)
            case "ended":
                self._over(event)
                self._run = {}

    def close(self) -> None:
        """The foot is wiped away."""
        self._put("", "")

    def _say(self, text: str) -> None:
        self._put(f"{text}\n", self._foot)

    def _draw(self, event: dict[str, Any]) -> None:
        width = _width(self.stream)
        lines = [line[:width] for line in self._lines(event)]
        self._put("", "\n".join([*lines, *keys_in(width, self._keys)]))

    def _lines(self, event: dict[str, Any]) -> list[str]:
        t, duration = event["t"], self._run["duration_s"]
        self._t = t
        share = min(max(t / duration, 0.0), 1.0) if duration > 0 else 0.0
        left = "" if event["state"] == HOLDING else self._left(t)  # a held run does not go on
        bar = ("█" * round(BAR * share)).ljust(BAR, "░")
        return [
            f"{self._mark}{event['state'].upper()} {self._run['title']} {bar} {t:.1f}/{duration:.1f} s{left}, "
            f"{peak(event)}",
            late(event),
        ]

    def _left(self, t: float) -> str:
        """Time left on the wall, once the pace is known."""
        now = time.monotonic()
        if not self._first[1]:
            self._first = (t, now)
        passed, took = t - self._first[0], now - self._first[1]
        if took < SETTLED or passed <= 0:
            return ""
        return f", {max(self._run['duration_s'] - t, 0.0) * took / passed:.0f} s left"

    def _over(self, event: dict[str, Any]) -> None:
        """The last numbers stay, as a line."""
        title, duration = self._run.get("title", "run"), self._run.get("duration_s", 0.0)
        self._put(
            f"{self._mark}{title}: {event['status']} after {self._t:.1f} of {duration:.1f} s, {peak(event)}\n", ""
        )

    def _put(self, text: str, foot: str) -> None:
        """`text` above, `foot` below it in place of the one there."""
        up = (UP * self._foot.count("\n")) + CLEAR if self._foot else ""
        if up or text or foot:
            self.write(up + text + foot)
        self._foot = foot


def keys_in(width: int, keys: Sequence[str] = KEYS) -> list[str]:
    """What each of `keys` does, in lines of at most `width` characters: who has to stop a motor finds none cut off."""
    lines = [keys[0]]
    for key in keys[1:]:
        longer = f"{lines[-1]}{APART}{key}"
        if len(longer) <= width:
            lines[-1] = longer
        else:
            lines.append(key)
    return [part for line in lines for part in textwrap.wrap(line, width, drop_whitespace=False)]


def _width(stream: TextIO) -> int:
    """Characters of a line; of a terminal that says 0 or 1, as a serial line does, those of the usual one."""
    try:
        columns = os.get_terminal_size(stream.fileno()).columns
    except (OSError, ValueError):
        columns = 0
    return columns - 1 if columns > 1 else 79
