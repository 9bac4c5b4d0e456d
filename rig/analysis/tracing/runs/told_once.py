"""What is said of many runs, once, with the runs counted."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final, NamedTuple

MANY: Final = 3  # runs of which the same is said: from so many on they are counted
NAMED: Final = 3  # of the counted ones
NUMBER: Final = re.compile(r"-?\d[\d.]*(e[-+]?\d+)?")


class Said(NamedTuple):
    """Of one run: its name, what became of it ("" or " was left out"), the reason, and whether its file is damaged."""

    run: str
    became: str
    reason: str
    damaged: bool = False

    def words(self) -> str:
        """As a sentence."""
        return f"{self.run}{self.became}: {self.reason.rstrip('.')}."


def left_out(run: str, reason: object, damaged: bool = False) -> Said:
    """Why a run was left out."""
    return Said(run, " was left out", str(reason), damaged)


def told_once(said: Sequence[Said]) -> list[str]:
    """A sentence for every reason, in the order they came up; numbers may differ from run to run."""
    alike: dict[tuple[str, str], list[Said]] = {}
    for one in said:
        alike.setdefault((one.became, NUMBER.sub("#", one.reason)), []).append(one)
    return [sentence for group in alike.values() for sentence in _told(group)]


def _told(group: Sequence[Said]) -> list[str]:
    if len(group) < MANY:
        return [one.words() for one in group]
    first = group[0]
    names = ", ".join(one.run for one in group[:NAMED]) + (" …" if len(group) > NAMED else "")
    became = first.became.replace("was", "were")
    of = "" if len({one.reason for one in group}) == 1 else f"; the numbers are those of {first.run}"
    return [f"{len(group)} runs ({names}){became}: {first.reason.rstrip('.')}{of}."]
