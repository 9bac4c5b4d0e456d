"""A kinematic error that is another one with time or speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.analysis.tracing.nameless.law import FAST, LONG, SEVERAL, WIDE, Amount, Nameless, largest_waves, wave_of, when
from rig.core.units import ARCSEC
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals


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
        return when(reach.fastest > WIDE * reach.slowest, (0.3,), (1.0,), (2.0,))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of both orders, and what they do to the lever."""
        return largest_waves(signals, (np.abs(signals.omega_m) / FAST) ** shape[0])

    def amount(self, fit: Fit) -> Amount:
        """Of the larger wave."""
        return wave_of(fit, "at 40 rad/s order 2 differs by a wave of", 1 / ARCSEC, "arcsec")
