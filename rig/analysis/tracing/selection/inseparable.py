"""Effects that no channel of a campaign can tell apart, whatever the numbers say."""

from __future__ import annotations

from collections.abc import Collection
from typing import Final

TORQUES: Final = frozenset({"tau_m", "tau_l"})
WIND_UP: Final = frozenset({"theta_m", "theta_l"})
RUNOUT, WEIGHT, CROSSTALK = "output_once_per_rev", "gravity_unbalance", "torque_sensor_crosstalk"


def inseparable(names: Collection[str], has: Collection[str]) -> tuple[str, ...]:
    """Rivals of `names` where `has` are the channels. In angles alone a weight that winds the gear up once an output
    turn is a runout, and either torque feels it. In the shaft torque alone it is the sensor's own crosstalk: the
    wind-up feels it, and the motor's torque."""
    known = set(has)
    rivals = {WEIGHT} if RUNOUT in names and not TORQUES & known else set()
    if "tau_m" not in known and not known >= WIND_UP:
        rivals |= {other for one, other in ((WEIGHT, CROSSTALK), (CROSSTALK, WEIGHT)) if one in names}
    return tuple(sorted(rivals - set(names)))
