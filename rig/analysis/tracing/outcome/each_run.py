"""What every run has to itself, held out or not: an error on it is then not wholly unseen, and that is said."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

OWN: Final = {"external_vibration": "phase and amplitude of the vibration", "missed_counts": "instants of the steps"}


def of_each_run(effects: Iterable[str]) -> str:
    """What was taken from a held-out run itself, "" where nothing was."""
    own = [OWN[name] for name in effects if name in OWN]
    return f"Each run, held out or not, has its own {' and '.join(own)}, read from that run itself." if own else ""
