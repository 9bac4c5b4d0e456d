"""A stiffness test of a gear maker: the motor's shaft is held, and a torque on the output winds the gear up.

It is the lock test the other way round: the load angle goes with the wind-up, and the motor's stays. Every run is at
one angle of the motor, so that of the kinematic error, which goes by that, nothing is seen but each run's zero.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.model.effect import Array

WINDS_UP_TO: Final = 0.1  # rad of the output, 6°: no flexspline lives through more, and a motor's encoder may be dead
STANDS: Final = 0.1  # of what the load's way is at the motor: a shaft that is held gives by less
WINDS_UP: Final = 0.02  # rad of the motor: a standstill's reading wanders by less


def is_input_locked(columns: Mapping[str, Array | None], ratio: float) -> bool:
    """Whether the load went a little and the motor stood, of a run in which both angles and the torque were read."""
    theta_m, theta_l, tau_l = (columns.get(name) for name in ("theta_m", "theta_l", "tau_l"))
    if theta_m is None or theta_l is None or tau_l is None:
        return False
    wound = float(np.nanmax(theta_l) - np.nanmin(theta_l))
    gone = ratio * wound
    return wound < WINDS_UP_TO and gone > WINDS_UP and float(np.nanmax(theta_m) - np.nanmin(theta_m)) < STANDS * gone
