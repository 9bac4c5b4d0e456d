"""What a reader of the numbers alone would take wrongly: what each run has to itself, held out or not, so that an error
on it is not wholly unseen; and at which load the refitted orders hold.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from rig.analysis.tracing.outcome.result import Found

OWN: Final = {
    "external_vibration": "phase and amplitude of the vibration, and of what stands beside its lines there",
    "missed_counts": "instants of the steps or zero after them",
    "channel_time_skew": "delay of one angle behind the other",
}


def of_each_run(effects: Iterable[Found]) -> str:
    """What was taken from a held-out run itself, "" where nothing was."""
    own = [OWN[found.effect] for found in effects if found.each_run]
    return f"Each run, held out or not, has its own {' and '.join(own)}, read from that run itself." if own else ""


LOADED: Final = "load_dependent_kinematic_error"
AT_LOAD: Final = (
    "The orders of the kinematic error after the refit are those without load; under a load many times T_c A_inf of "
    "them is left."
)


def beside_the_numbers(effects: Iterable[Found]) -> list[str]:
    """Notes on what the numbers of these effects mean, one sentence each."""
    found = tuple(effects)
    own = of_each_run(found)
    return [*([own] if own else []), *([AT_LOAD] if any(f.effect == LOADED for f in found) else [])]
