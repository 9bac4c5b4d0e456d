"""How one run of a session ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

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
