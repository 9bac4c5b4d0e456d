"""An angle that is read to another scale."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import BOTH_ANGLES, SEVERAL, WIDE, Amount, Nameless, sum_of, when
from rig.core.units import ARCSEC
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals

SIZE: Final = 1e-4  # rad a turn of the output, for a column of the others' size


class OtherScale(Nameless):
    """The load angle runs away from the motor's by the same with every turn, at any speed, and comes back: a counter
    that is scaled in rounded numbers, or another ratio than was stated      [heidenhain]

    At one speed it is a drift in time, and in one log an angle.
    """

    name: ClassVar[str] = "other_scale"
    in_short: ClassVar[str] = "the load angle is read to another scale than the motor's"
    source: ClassVar[str] = "heidenhain"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs at several speeds."""
        return when(reach.runs >= SEVERAL and reach.fastest > WIDE * reach.slowest)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading, by the motor's angle, whose noise is a fiftieth."""
        turns = np.nan_to_num(signals.theta_m) / (2.0 * np.pi * signals.ratio)
        return {Port.READS_THETA_L: SIZE * turns[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """With every turn."""
        return sum_of(fit, "with every turn of the output it reads too much by", SIZE / ARCSEC, "arcsec")
