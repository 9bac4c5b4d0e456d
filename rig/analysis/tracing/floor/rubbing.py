"""What a run leaves beside a friction of its own: how far that lies from the others' says nothing of the rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.model.effect import Array


@dataclass(frozen=True)
class Rubbing:
    """A block of the motor torque of a run that goes both ways: its way (n,), its floor without what friction scatters
    by from run to run [N·m], and how much more than that it may leave by chance."""

    way: Array
    floor: float
    lenient: float

    def over(self, e: Array) -> float:
        """RMS of `e` (n,) beside a mean and a constant friction, over what it may be."""
        z = np.stack([np.ones(e.size), self.way], 1)
        left = e - z @ np.linalg.lstsq(z, e, rcond=None)[0]
        return float(np.sqrt(np.mean(left**2))) / self.floor / self.lenient
