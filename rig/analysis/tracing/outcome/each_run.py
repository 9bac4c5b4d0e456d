"""What a reader of the numbers alone would take wrongly: what each run has to itself, held out or not, so that an error
on it is not wholly unseen; and at which load the refitted orders hold.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

OWN: Final = {
    "external_vibration": "phase and amplitude of the vibration, and of what stands beside its lines there",
    "missed_counts": "instants of the steps or zero after them",
}


def of_each_run(effects: Iterable[str]) -> str:
    """What was taken from a held-out run itself, "" where nothing was."""
    own = [OWN[name] for name in effects if name in OWN]
    return f"Each run, held out or not, has its own {' and '.join(own)}, read from that run itself." if own else ""


LOADED: Final = "load_dependent_kinematic_error"
AT_LOAD: Final = (
    "The orders of the kinematic error after the refit are those without load; under a load many times T_c A_inf of "
    "them is left."
)


def beside_the_numbers(effects: Iterable[str]) -> list[str]:
    """Notes on what the numbers of these effects mean, one sentence each."""
    names = tuple(effects)
    own = of_each_run(names)
    return [*([own] if own else []), *([AT_LOAD] if LOADED in names else [])]
