"""A stiffness that is no constant: uneven, or another one with time or speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from rig.analysis.tracing.nameless.law import (
    BOTH_ANGLES,
    FAST,
    SEVERAL,
    WIDE,
    Amount,
    Nameless,
    by_time,
    sum_of,
    torque_of,
    when,
)
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals


class EvenSpring(Nameless):
    """A spring harder one way than the other: φ loses c·T²      [tuttle1992]

    In a lock test the motor's angle goes with the torque, and any stiffness that changes with that angle does the same.
    """

    name: ClassVar[str] = "even_spring"
    in_the_spring: ClassVar[bool] = True
    in_short: ClassVar[str] = "the spring is harder one way than the other"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where torques pull both ways: of one way alone it may as well be harder the more it is wound up."""
        return when(reach.pulled_both_ways)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.WIND_UP: -(torque_of(signals) ** 2)[:, None]}


class SpringDrift(Nameless):
    """The stiffness changes through the campaign, as of a gear that warms: θ̃ gains T·(c_1·t + c_2·t²)      [tuttle1992]

    Loads come in an order, and a spring that gives more in the later runs is a loop, a knee, or a late encoder.
    """

    name: ClassVar[str] = "spring_drift"
    in_the_spring: ClassVar[bool] = True
    in_short: ClassVar[str] = "the stiffness changes through the campaign"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"t"}

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs."""
        return when(reach.runs >= SEVERAL)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns, by LONG and its square."""
        return {Port.WIND_UP: by_time(torque_of(signals), signals)}

    def amount(self, fit: Fit) -> Amount:
        """Relative, of the stiffness."""
        return sum_of(fit, "in 1000 s the stiffness changes by", -100 * fit.known.K, "%")


class SpringBySpeed(Nameless):
    """The stiffness changes with the speed: θ̃ gains c·T·|ω_m|      [tuttle1992]"""

    name: ClassVar[str] = "spring_by_speed"
    in_short: ClassVar[str] = "the stiffness changes with the speed"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"t"}

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where speeds differ."""
        return when(reach.speeds_differ(WIDE))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.WIND_UP: (torque_of(signals) * np.abs(signals.omega_m) / FAST)[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """Relative, of the stiffness."""
        return sum_of(fit, "at 40 rad/s the stiffness differs by", -100 * fit.known.K, "%")


class SpringByWarmth(Nameless):
    """The stiffness follows a temperature that was logged: θ̃ gains c·T·(Θ − 20 °C)      [tuttle1992]"""

    name: ClassVar[str] = "spring_by_warmth"
    in_the_spring: ClassVar[bool] = True
    in_short: ClassVar[str] = "the stiffness follows the temperature"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"temperature"}
    REFERENCE: ClassVar[float] = 20.0  # °C

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs."""
        return when(reach.runs >= SEVERAL and "temperature" in reach.has)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        warmer = np.nan_to_num(signals.temperature, nan=self.REFERENCE) - self.REFERENCE
        return {Port.WIND_UP: (torque_of(signals) * warmer)[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """Relative, of the stiffness."""
        return sum_of(fit, "for each kelvin the stiffness changes by", -100 * fit.known.K, "%")
