"""Every event as a JSON line on stdout, and nothing else; the table of events is in `show`."""

from __future__ import annotations

import json
import time
from typing import Any, TextIO, final

from rig.commands.show.screens import Screen
from rig.core.clock import NEVER

PERIOD = 0.5  # s between two lines of progress


@final
class JsonLines(Screen):
    """As they come; of progress two a second."""

    def __init__(self, stream: TextIO) -> None:
        super().__init__(stream)
        self._told = NEVER

    def take(self, event: dict[str, Any]) -> None:
        """One event as a line of JSON."""
        if event["event"] == "progress":
            now = time.monotonic()
            if now - self._told < PERIOD:
                return
            self._told = now
        self.write(json.dumps(event) + "\n")

    def close(self) -> None:
        """Nothing is left over."""
        return
