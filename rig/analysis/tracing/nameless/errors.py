"""A kinematic error that is another one with time or speed, or has more orders than the paper's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.analysis.tracing.nameless.law import (
    BOTH_ANGLES,
    FAST,
    LONG,
    SEVERAL,
    WIDE,
    Amount,
    Nameless,
    largest_waves,
    wave_of,
    when,
)
from rig.core.units import ARCSEC
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals
from rig.model.waves import powers


class ErrorDrift(Nameless):
    """The kinematic error changes through the campaign, as of a gear that warms or runs in: waves of the motor's angle
    that grow with the time      [jia2021]
    """

    name: ClassVar[str] = "error_drift"
    in_short: ClassVar[str] = "the kinematic error changes through the campaign"
    source: ClassVar[str] = "jia2021"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs."""
        return when(reach.runs >= SEVERAL)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order by LONG, and what they do to the lever."""
        return largest_waves(signals, signals.t / LONG)

    def amount(self, fit: Fit) -> Amount:
        """Of the larger wave."""
        return wave_of(fit, "in 1000 s order 2 changes by a wave of", 1 / ARCSEC, "arcsec")


class ErrorBySpeed(Nameless):
    """The kinematic error grows or shrinks with the speed, as what spins is thrown outwards or rides on a film of oil:
    waves of the motor's angle times |ω_m|^p      [jia2021]"""

    name: ClassVar[str] = "error_by_speed"
    in_short: ClassVar[str] = "the kinematic error changes with the speed"
    source: ClassVar[str] = "jia2021"
    shape_names: ClassVar[tuple[str, ...]] = ("power",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Powers: a film that builds up at once, one that grows, a force that goes with the square."""
        return when(reach.speeds_differ(WIDE), (0.3,), (1.0,), (2.0,))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of both orders, and what they do to the lever."""
        return largest_waves(signals, (np.abs(signals.omega_m) / FAST) ** shape[0])

    def amount(self, fit: Fit) -> Amount:
        """Of the larger wave."""
        return wave_of(fit, "at 40 rad/s order 2 differs by a wave of", 1 / ARCSEC, "arcsec")


class SharpError(Nameless):
    """The kinematic error is sharper than the paper's fifteen orders, as over a dent in a race: the next ones as well,
    and their lever      [ghorbel2001, Eq. 8]

    Under load the lever is in the motor's torque, in proportion to it, as ripple would be.
    """

    name: ClassVar[str] = "sharp_error"
    in_short: ClassVar[str] = "the kinematic error is sharper than fifteen orders"
    source: ClassVar[str] = "ghorbel2001"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES
    FIRST: ClassVar[int] = 16
    LAST: ClassVar[int] = 32  # of a bump 0.1 rad wide a hundredth is beyond

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order, and their slopes."""
        orders = np.arange(self.FIRST, self.LAST + 1, dtype=np.float64)
        kept = np.repeat(np.stack([signals.kept(k, signals.omega_m) for k in orders], 1), 2, axis=1)
        beyond = slice(2 * (self.FIRST - 1), None)
        values, slopes = (powers(signals.theta_m, self.LAST, slopes=which)[:, beyond] for which in (False, True))
        return {Port.KINEMATIC_ERROR: values * kept, Port.LEVER: slopes}

    def amount(self, fit: Fit) -> Amount:
        """Of the first of them: of the others there may be as much."""
        return wave_of(fit, f"order {self.FIRST} is a wave of", 1 / ARCSEC, "arcsec")
