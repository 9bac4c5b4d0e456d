"""How one run of a session ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from rig.core.errors import Exit, HdrigError
from rig.core.sample import Sample
from rig.loop import Ending

Watch = Callable[[Sample], None]  # shown a sample now and then while a run goes on


def nobody(sample: Sample) -> None:
    """A watch of nobody's."""


@dataclass(frozen=True)
class Done:
    """A run that came to an end, its folder closed."""

    folder: Path
    ending: Ending


class Ended(HdrigError):
    """A run that others build on was ended by the guard or the operator: its exit code is the command's."""

    def __init__(self, sentence: str, exit: Exit) -> None:
        super().__init__(sentence)
        self.exit = exit
