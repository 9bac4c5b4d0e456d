"""What stays behind: creep of the spring, play of a coupling, the torque sensor's own drag and hysteresis."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import (
    BOTH_ANGLES,
    Amount,
    Nameless,
    OfTheTorqueSensor,
    sum_of,
    torque_of,
    when,
)
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals
from rig.model.memory import follower, play

TURNED: Final = 2e-5  # rad: gone through within a row of the slow run, so its size tells nothing but the height


class Creep(Nameless):
    """A part of the wind-up that comes late: φ gains Σ c_i·(T through a first-order lag of T_i)      [findley1976]

    A loop in torque against wind-up as hysteresis makes it, but one that closes when it is gone round slowly. A load
    that was hung up just before has not wound up all of it when a run begins: φ gains Σ d_i·T(0)·exp(−t/T_i) besides.
    """

    name: ClassVar[str] = "creep"
    in_the_spring: ClassVar[bool] = True
    in_short: ClassVar[str] = "a part of the wind-up comes seconds late"
    source: ClassVar[str] = "findley1976"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"t"}
    remembers: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("begun",)
    loose: ClassVar[tuple[bool, ...]] = (False,)
    LAGS: Final = (0.7, 1.5, 4.0, 8.0, 20.0, 50.0)  # s: from a turn of the motor to a run, 2 to 3 times apart
    IN_BALANCE: ClassVar[float] = 0.0
    JUST_HUNG: ClassVar[float] = 1.0

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Of runs that begin in balance, and where loads were hung up just before; none in a campaign shorter than its
        lags, where they are powers of the time and foretell any drift."""
        if reach.duration <= self.LAGS[-1]:
            return ()
        return ((self.IN_BALANCE,), (self.JUST_HUNG,)) if reach.weights > 1 else ((self.IN_BALANCE,),)

    def has_state(self) -> bool:
        """It comes late."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One follower a lag, in balance when the run begins, and what fades since then."""
        torque = torque_of(signals)
        keep = np.exp(-signals.dt / np.array(self.LAGS))
        late = [torque[0] + follower(torque - torque[0], 1 - k, 0.0, k, 0.0) for k in keep]
        if shape[0] == self.JUST_HUNG:
            late += [torque[0] * k ** np.arange(torque.size) for k in keep]
        return {Port.WIND_UP: np.stack(late, 1)}


class CouplingPlay(Nameless):
    """The load encoder's coupling has play: its reading stays behind by half of it, whichever way it is turned, and
    whatever the torque      [nordin2002]

    Under the load's own friction it is what a loop in the spring or lost motion would be; a locked output shows none.
    """

    name: ClassVar[str] = "coupling_play"
    in_short: ClassVar[str] = "an encoder's coupling has play"
    source: ClassVar[str] = "nordin2002"

    def has_state(self) -> bool:
        """It stays behind."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading, for half the play of 1 rad."""
        return {Port.READS_THETA_L: -way_of_the_output(signals)}

    def plausible(self, fit: Fit) -> bool:
        """It stays behind."""
        return bool(fit.coefficients[0] > 0)


class DraggedSensor(OfTheTorqueSensor):
    """The torque sensor has a bearing of its own, whose drag it reads but the gear does not feel: c·sgn ω_l too much

    [taghirad1999]. To load and motor that is constant friction; the gear is wound up by so much less than is read,
    where lost motion and loops wind it up by more. A locked output shows none.
    """

    name: ClassVar[str] = "dragged_sensor"
    in_short: ClassVar[str] = "the torque sensor reads a drag of its own"
    source: ClassVar[str] = "taghirad1999"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"tau_l"}

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where it turns both ways."""
        return when(reach.both_ways)

    def has_state(self) -> bool:
        """It is told by where the output came from."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        return {Port.READS_TAU_L: way_of_the_output(signals)}

    def plausible(self, fit: Fit) -> bool:
        """It drags."""
        return bool(fit.coefficients[0] > 0)

    def amount(self, fit: Fit) -> Amount:
        """Its drag."""
        return sum_of(fit, "it is", 1, "N·m")


def way_of_the_output(signals: Signals) -> Array:
    """−1 to 1 (n, 1): its sign since it last moved by more than 2·TURNED; of a locked output next to nothing."""
    angle = np.ascontiguousarray(np.nan_to_num(signals.theta_l))
    return np.asarray((angle - play(angle, TURNED)) / TURNED)[:, None]


class SensorLoop(OfTheTorqueSensor):
    """The torque sensor's own hysteresis: it reads Σ c_i·P_{r_i}[T] too much, play operators of the torque [kuhnen2003]

    In a lock test it is a loop in the spring; where the output is free the torque it makes up accelerates no load and
    loads no motor. What it was left behind by before a run is not known: it starts from there, and its zero is the
    run's own.
    """

    name: ClassVar[str] = "sensor_loop"
    in_short: ClassVar[str] = "the torque sensor has hysteresis"
    source: ClassVar[str] = "kuhnen2003"
    of_reading: ClassVar[str] = "torque"
    needs: ClassVar[frozenset[str]] = BOTH_ANGLES | {"tau_l"}
    remembers: ClassVar[bool] = True
    # N·m, half: from the swing of a slow run to that of a lock test, so near that a loop in the spring fits no better
    WIDTHS: Final = (0.5, 1.0, 2.0, 4.0, 6.0, 8.0, 11.0, 14.0, 18.0, 25.0, 32.0, 40.0, 55.0)
    STEEPEST: Final = 0.05  # of a change of the torque, as gauges that slip make in the worst case; rather its noise

    def has_state(self) -> bool:
        """A loop."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """What each play stays behind by."""
        torque = np.ascontiguousarray(torque_of(signals))
        torque = torque - torque[0]
        return {Port.READS_TAU_L: np.stack([torque - play(torque, width) for width in self.WIDTHS], 1)}

    def plausible(self, fit: Fit) -> bool:
        """It reads nearly all of a small change: what takes more off takes the sensor's noise, where little else in
        the campaign tells what the torque does."""
        return float(np.sum(fit.coefficients)) < self.STEEPEST
