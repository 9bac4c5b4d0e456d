"""An angle that is read to another scale, or by a mount that warms."""

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
        return when(reach.runs >= SEVERAL and reach.speeds_differ(WIDE))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading, by the motor's angle, whose noise is a fiftieth."""
        turns = np.nan_to_num(signals.theta_m) / (2.0 * np.pi * signals.ratio)
        return {Port.READS_THETA_L: SIZE * turns[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """With every turn."""
        return sum_of(fit, "with every turn of the output it reads too much by", SIZE / ARCSEC, "arcsec")


class WarmedMount(Nameless):
    """What holds the load's encoder twists as it warms by the motor's friction, and cools: θ_l is read too high by
    c·(h(t) − h(t_0)), h that heat as it leaks with a time t_w, t_0 where the run began      [heidenhain]

    Within a run that is nearly a reading that falls behind with the way; but it settles, and after a fast run a slow
    one creeps back.
    """

    name: ClassVar[str] = "warmed_mount"
    in_short: ClassVar[str] = "the load encoder's mount twists as it warms"
    source: ClassVar[str] = "heidenhain"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"t"}
    shape_names: ClassVar[tuple[str, ...]] = ("t_w",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    LEAKS: Final = tuple(round(15.0 * 1.5**k) for k in range(12))  # s: a bracket of a hand's size to a gear box
    HEATED: Final = 100.0  # J, for a column of one size

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Times that some runs reach, of several runs at several speeds."""
        times = ((float(t_w),) for t_w in self.LEAKS if t_w < reach.duration)
        return when(reach.runs >= SEVERAL and reach.speeds_differ(WIDE), *times)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """About those that are tried."""
        return ((self.LEAKS[0] / 2, 2.0 * self.LEAKS[-1]),)

    def has_state(self) -> bool:
        """What it was where the run began."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        heat = signals.heat(shape[0]) / self.HEATED
        return {Port.READS_THETA_L: (heat - heat[:1])[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """By 100 J."""
        return sum_of(
            fit, f"leaking with {fit.shape[0]:.3g} s, 100 J of friction turn the reading by", 1 / ARCSEC, "arcsec"
        )
