"""What a torque sensor reads too much, and a torque constant that is none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import (
    BOTH_ANGLES,
    FAST,
    SEVERAL,
    WIDE,
    Amount,
    Nameless,
    OfTheTorqueSensor,
    by_time,
    sum_of,
    torque_of,
    wave_of,
    when,
)
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals
from rig.model.waves import wave

TOLD: Final = 2  # different weights


class SensorWaves(OfTheTorqueSensor):
    """The torque sensor feels the wave generator: it reads waves of the motor's angle too much      [taghirad1999]

    The motor's torque has an Nth of them left over, as if it cogged; the load's inertia knows of none.
    """

    name: ClassVar[str] = "sensor_waves"
    in_short: ClassVar[str] = "the torque sensor feels the wave generator"
    source: ClassVar[str] = "taghirad1999"
    ORDERS: Final = (1, 2, 4)  # of the motor: an eccentricity, the two lobes and their square

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order in the reading."""
        return {Port.READS_TAU_L: np.concatenate([wave(k * signals.theta_m) for k in self.ORDERS], 1)}


class SensorRipple(OfTheTorqueSensor):
    """The torque sensor's gauges feel the wave generator, the more the more they carry: waves of the motor's angle, and
    the same waves times the torque      [taghirad1999]

    A gauge on a flexspline that turns under it reads so; the orders are those of SensorWaves.
    """

    name: ClassVar[str] = "sensor_ripple"
    in_short: ClassVar[str] = "the torque sensor has a ripple of the motor's angle"
    source: ClassVar[str] = "taghirad1999"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs."""
        return when(reach.runs >= SEVERAL)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order in the reading, and both times the torque."""
        waves = SensorWaves().columns(signals, ())[Port.READS_TAU_L]
        return {Port.READS_TAU_L: np.concatenate([waves, waves * torque_of(signals)[:, None]], 1)}

    def amount(self, fit: Fit) -> Amount:
        """Twice a turn, of the torque."""
        return wave_of(fit, "twice a motor turn by", 100, "% of the torque", 2 * SensorWaves.ORDERS.index(2) + 6)


class SensorGainDrift(OfTheTorqueSensor):
    """The torque sensor's gain changes through the campaign: it reads T·(c_1·t + c_2·t²) too much   [taghirad1999]"""

    name: ClassVar[str] = "sensor_gain_drift"
    in_short: ClassVar[str] = "the torque sensor's gain changes through the campaign"
    source: ClassVar[str] = "taghirad1999"
    of_reading: ClassVar[str] = "torque"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"t", "tau_l"}

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs."""
        return when(reach.runs >= SEVERAL)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns in the reading."""
        return {Port.READS_TAU_L: by_time(torque_of(signals), signals)}

    def amount(self, fit: Fit) -> Amount:
        """Relative."""
        return sum_of(fit, "in 1000 s the gain changes by", 100, "%")


class ThrownSensor(OfTheTorqueSensor):
    """The torque sensor reads more the faster it turns, whichever way, as one whose bridge is thrown outward: c·ω_m²

    [taghirad1999]. The motor's torque has an Nth of it left over, as if it were dragged by more one way.
    """

    name: ClassVar[str] = "thrown_sensor"
    in_short: ClassVar[str] = "the torque sensor reads with the square of the speed"
    source: ClassVar[str] = "taghirad1999"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where it turns fast both ways, or it is any drag of the load, and not at one speed."""
        return when(reach.fast_both_ways and reach.speeds_differ(WIDE) and reach.runs >= SEVERAL)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_TAU_L: (signals.omega_m / FAST)[:, None] ** 2}

    def amount(self, fit: Fit) -> Amount:
        """At FAST."""
        return sum_of(fit, "at 40 rad/s of the motor it reads too much by", 1, "N·m")


class SensorScale(OfTheTorqueSensor):
    """The scale of the torque sensor is off: it reads c·T too much, by what weights and the motor say [taghirad1999]

    In the angles that is another stiffness; a weight that was declared and a load that was weighed know of nothing.
    """

    name: ClassVar[str] = "sensor_scale"
    in_short: ClassVar[str] = "the scale of the torque sensor is off"
    source: ClassVar[str] = "taghirad1999"
    of_reading: ClassVar[str] = "torque"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where different weights tell."""
        return when(reach.weights > 1)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_TAU_L: torque_of(signals)[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """Of the reading."""
        return sum_of(fit, "of what it reads too much is", 100, "%")


class TwoGains(OfTheTorqueSensor):
    """The torque sensor's gain is another one for negative torque: it reads c_1·|T| + c_2·T² too much

    [taghirad1999]. In a lock test the motor's angle goes with the torque, and any stiffness that changes with it does
    the same to the angles; the motor that holds it tells.
    """

    name: ClassVar[str] = "two_gains"
    in_short: ClassVar[str] = "the torque sensor has two gains"
    source: ClassVar[str] = "taghirad1999"
    of_reading: ClassVar[str] = "torque"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"tau_l"}
    AT: Final = 50.0  # N·m, for columns of one size

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where there is torque of both signs."""
        return when(reach.pulled_both_ways)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns in the reading."""
        torque = torque_of(signals)
        return {Port.READS_TAU_L: np.stack([np.abs(torque), torque**2 / self.AT], 1)}

    def amount(self, fit: Fit) -> Amount:
        """Relative, at AT."""
        return sum_of(fit, f"at {self.AT:g} N·m the gain for positive torque is larger by", 200, "%")


class SensorJump(OfTheTorqueSensor):
    """The torque sensor jumps where the torque turns round, as one whose hub slips: it reads c·tanh(T/T_0) too much

    [taghirad1999]. In a lock test that is a soft or a free gap of the gear; the load's inertia knows of none.
    """

    name: ClassVar[str] = "sensor_jump"
    in_short: ClassVar[str] = "the torque sensor jumps where the torque turns round"
    source: ClassVar[str] = "taghirad1999"
    of_reading: ClassVar[str] = "torque"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"tau_l"}
    TURN: Final = 1.0  # N·m: within what runs without load swing by

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where there is torque of both signs."""
        return when(reach.pulled_both_ways)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_TAU_L: np.tanh(torque_of(signals) / self.TURN)[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """From one side to the other."""
        return sum_of(fit, "from one side to the other by", 2, "N·m")


class SensorCurve(OfTheTorqueSensor):
    """The torque sensor is not linear: it reads c_2·T·|T| + c_3·T³ too much, one way as the other      [taghirad1999]

    Or its amplifier gives way near the end of its range: it reads c·(|T| − T_k)·sgn T too much beyond T_k. In a lock
    test the gear seems to stiffen or to soften; the motor that holds it, and where it turns the load, know of nothing.
    """

    name: ClassVar[str] = "sensor_curve"
    in_short: ClassVar[str] = "the torque sensor is not linear"
    source: ClassVar[str] = "taghirad1999"
    of_reading: ClassVar[str] = "torque"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"tau_l", "tau_m"}
    shape_names: ClassVar[tuple[str, ...]] = ("knee",)
    loose: ClassVar[tuple[bool, ...]] = (False,)
    AT: Final = 50.0  # N·m, for columns of one size
    SMOOTH: Final = 0.0  # no knee
    KNEES: Final = tuple(0.95 * 0.9**k for k in range(15))  # of the largest torque

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """A curve, and knees, where there is torque enough to bend one."""
        knees = ((round(share * reach.torque, 1),) for share in self.KNEES)
        return when(reach.torque > self.AT / 2, (self.SMOOTH,), *knees)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns in the reading, for what it is off at AT; beyond a knee one."""
        torque = torque_of(signals)
        if shape[0] != self.SMOOTH:
            beyond = np.maximum(np.abs(torque) - shape[0], 0.0)
            return {Port.READS_TAU_L: (np.sign(torque) * beyond)[:, None]}
        share = torque / self.AT
        return {Port.READS_TAU_L: np.stack([share * np.abs(share), share**3], 1)}

    def amount(self, fit: Fit) -> Amount:
        """At AT, both together; beyond a knee of what exceeds it."""
        if fit.shape[0] != self.SMOOTH:
            return sum_of(fit, f"of what exceeds {fit.shape[0]:g} N·m it reads too much by", 100, "%")
        return sum_of(fit, f"at {self.AT:g} N·m it reads too much by", 1, "N·m")


class Droop(Nameless):
    """The torque constant falls with the current: the torque told is c_2·τ_m·|τ_m| + c_3·τ_m³ too high, as iron begins
    to saturate and as it goes on to      [krause2013]

    Under a steady load it is what friction would be that grows with the square of it, but it gives as it takes.
    """

    name: ClassVar[str] = "droop"
    in_short: ClassVar[str] = "the torque constant falls with the current"
    source: ClassVar[str] = "krause2013"
    of_reading: ClassVar[str] = "tau_m"

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where something else tells the torque."""
        return when(_is_told(reach))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns in the reading."""
        torque = np.nan_to_num(signals.tau_m)
        return {Port.READS_TAU_M: np.stack([torque * np.abs(torque), torque**3], 1)}

    def amount(self, fit: Fit) -> Amount:
        """At 1 N·m, both together."""
        return sum_of(fit, "at 1 N·m the torque told is too high by", 1e3, "mN·m")


class ConstantDrift(Nameless):
    """The torque constant changes through the campaign, as magnets weaken that warm: the torque told is
    τ_m·(c_1·t + c_2·t²) too high      [krause2013]"""

    name: ClassVar[str] = "constant_drift"
    in_short: ClassVar[str] = "the torque constant changes through the campaign"
    source: ClassVar[str] = "krause2013"
    of_reading: ClassVar[str] = "tau_m"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, of several runs, where something else tells the torque."""
        return when(reach.runs >= SEVERAL and _is_told(reach))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two columns in the reading."""
        return {Port.READS_TAU_M: by_time(np.nan_to_num(signals.tau_m), signals)}

    def amount(self, fit: Fit) -> Amount:
        """Relative."""
        return sum_of(fit, "in 1000 s the torque told for the same torque changes by", 100, "%")


class TwoConstants(Nameless):
    """The torque constant is another one for negative current: the torque told is c·|τ_m| too high      [krause2013]"""

    name: ClassVar[str] = "two_constants"
    in_short: ClassVar[str] = "the motor has two torque constants"
    source: ClassVar[str] = "krause2013"
    of_reading: ClassVar[str] = "tau_m"
    MOST: Final = 0.1  # relative

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where there is torque of both signs, and something else tells it."""
        return when(reach.pulled_both_ways and _is_told(reach))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_TAU_M: np.abs(np.nan_to_num(signals.tau_m))[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """Relative."""
        return sum_of(fit, "for positive torque the reading is larger by", 200, "%")

    def plausible(self, fit: Fit) -> bool:
        """A tenth at most between both: a drive's sensors of current agree to a few hundredths. More is friction, under
        weights that pull one way alone."""
        return bool(2.0 * abs(fit.coefficients[0]) < self.MOST)


def _is_told(reach: Reach) -> bool:
    """Whether a sensor or different weights tell the torque that the motor's is held against: of friction alone any law
    of the motor's torque would foretell itself."""
    return "tau_l" in reach.has or reach.weights >= TOLD
