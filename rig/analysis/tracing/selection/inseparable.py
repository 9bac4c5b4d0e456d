"""Effects that no channel of a campaign can tell apart, whatever the numbers say."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

TORQUES: Final = frozenset({"tau_m", "tau_l"})
RUNOUT, WEIGHT = "output_once_per_rev", "gravity_unbalance"


def inseparable(names: Collection[str], has: Collection[str]) -> tuple[str, ...]:
    """Rivals of `names` where `has` are the channels: in angles alone a weight that winds the gear up once an output
    turn is a runout, and either torque feels it."""
    return (WEIGHT,) if RUNOUT in names and not TORQUES & set(has) else ()
