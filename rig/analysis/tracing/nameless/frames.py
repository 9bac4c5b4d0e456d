"""What a weight does to the frame and the shaft it hangs on, beside what its torque does to the gear."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import BOTH_ANGLES, Amount, Nameless, sum_of, when
from rig.core.units import ARCSEC
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals

SIZE: Final = 20.0  # N·m, for a column of the others' size


class PulledAside(Nameless):
    """What hangs on the output pulls its shaft aside, and the load encoder reads c·τ_ext too much      [heidenhain]

    To the wind-up that is a compliance, or one that comes late; a locked output under the same torque shows none of it.
    """

    name: ClassVar[str] = "pulled_aside"
    in_short: ClassVar[str] = "a weight shifts the load angle, and its torque in a lock test does not"
    source: ClassVar[str] = "heidenhain"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES
    WEIGHTS: ClassVar[int] = 3  # with fewer, and nothing, it is any zero that another run has

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where several weights were declared."""
        return when(reach.weights >= self.WEIGHTS)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_THETA_L: np.nan_to_num(signals.tau_ext)[:, None] / SIZE}

    def amount(self, fit: Fit) -> Amount:
        """For each N·m."""
        return sum_of(fit, "each N·m of it shifts the angle by", 1 / (SIZE * ARCSEC), "arcsec")
