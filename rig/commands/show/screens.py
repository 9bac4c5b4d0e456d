"""The ways of showing events, by name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, TextIO


class Screen(ABC):
    """Draws events as they come, in order."""

    def __init__(self, stream: TextIO) -> None:
        self.stream = stream

    @abstractmethod
    def take(self, event: dict[str, Any]) -> None:
        """Draw one event; keys it lacks are as good as null."""

    @abstractmethod
    def close(self) -> None:
        """No event follows."""

    def write(self, text: str) -> None:
        """To the stream, in characters it has, at once. Raises OSError when nobody is there any more."""
        encoding = self.stream.encoding or "utf-8"
        self.stream.write(text.encode(encoding, "replace").decode(encoding))
        self.stream.flush()


def screen_for(how: str, stream: TextIO, keyed: bool = True) -> Screen:
    """`how` is screen or json; anything else is lines. `keyed`: somebody's keys are heard, and a screen says which."""
    from rig.commands.show.json_lines import JsonLines
    from rig.commands.show.lines import Lines
    from rig.commands.show.terminal import Terminal

    match how:
        case "screen":
            return Terminal(stream, keyed)
        case "json":
            return JsonLines(stream)
        case _:
            return Lines(stream)
