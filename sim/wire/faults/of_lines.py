"""Faults of the serial lines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import final

from sim.wire.faults.words import named
from sim.wire.pty import SerialLine, Spoiler
from sim.wire.spoilers import Cut, Garbage, Glued, Mute, Torn

VERBS: dict[type[Spoiler], str] = {Cut: "shortened"}  # the others are called as their class


@final
class LineFaults:
    """Of the serial lines."""

    def __init__(self, lines: Mapping[str, SerialLine]) -> None:
        self._lines = lines

    def heal(self) -> None:
        """All sound and plugged in."""
        for line in self._lines.values():
            line.spoiler, line.latency = Spoiler(), 0.0
            line.plug()

    def choices(self) -> dict[str, Iterable[str]]:
        """What a line may be."""
        return {"line": self._lines}

    def standing(self) -> list[str]:
        """What is not sound, line by line."""
        return [f"{fault} line={name}" for name, line in self._lines.items() for fault in _wrong(line)]

    def unplug(self, line: str) -> None:
        """The plug is pulled"""
        self._line(line).unplug()

    def plug(self, line: str) -> None:
        """It is back, as another pty behind the same link; the device starts anew"""
        self._line(line).plug()

    def restart(self, line: str) -> None:
        """The device loses its power, or is reset by DTR, while the line stays: zero, counter, registers are as new"""
        self._line(line).device.plugged()

    def torn(self, line: str, seconds: float = 0.005) -> None:
        """Every message arrives in two pieces"""
        self._line(line).spoiler = Torn(float(seconds))

    def glued(self, line: str) -> None:
        """Two messages are one: the end of line between them is lost"""
        self._line(line).spoiler = Glued()

    def shortened(self, line: str, size: int = 2, count: float = math.inf) -> None:
        """Bytes before the end of line are lost"""
        self._line(line).spoiler = Cut(size, count)

    def garbage(self, line: str, size: int = 5) -> None:
        """Bytes that mean nothing before every message"""
        self._line(line).spoiler = Garbage(size)

    def mute(self, line: str) -> None:
        """Nothing arrives any more"""
        self._line(line).spoiler = Mute()

    def latency(self, line: str, seconds: float = 0.016) -> None:
        """The adapter hands over what it has only every so often"""
        self._line(line).latency = float(seconds)

    def _line(self, name: str) -> SerialLine:
        return named(self._lines, name, "serial line")


def _wrong(line: SerialLine) -> list[str]:
    spoiled = "" if line.spoiler.sound else VERBS.get(type(line.spoiler), type(line.spoiler).__name__.lower())
    found = ("" if line.present else "unplug", spoiled, f"latency seconds={line.latency:g}" if line.latency else "")
    return [fault for fault in found if fault]
