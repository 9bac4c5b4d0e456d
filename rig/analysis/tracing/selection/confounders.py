"""Confounders: laws that are no effect of the library and look like one of it. None is ever named, but where one
explains more, the effect it was taken for is not named either. They are searched for beside the library's.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import Solution, extended, fit
from rig.analysis.tracing.fit.search import Scored, reduced
from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals
from rig.model.memory import follower, play
from rig.model.waves import wave


class Nameless(Effect):
    """A law that is never named: of one shape unless it says otherwise, and without figures."""

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One."""
        return ((),)

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """None: what is not named has no figures."""
        return ()


class Creep(Nameless):
    """A part of the wind-up that comes late: φ gains Σ c_i·(T through a first-order lag of T_i)      [findley1976]

    A loop in torque against wind-up as hysteresis makes it, but one that closes when it is gone round slowly.
    """

    name: ClassVar[str] = "creep"
    in_short: ClassVar[str] = "a part of the wind-up comes seconds late"
    source: ClassVar[str] = "findley1976"
    remembers: ClassVar[bool] = True
    LAGS: Final = (0.7, 1.5, 4.0, 8.0, 20.0, 50.0)  # s: from a turn of the motor to a run, 2 to 3 times apart

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One; none in a campaign shorter than its lags, where they are powers of the time and foretell any drift."""
        return ((),) if reach.duration > self.LAGS[-1] else ()

    def has_state(self) -> bool:
        """It comes late."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One follower a lag, in balance when the run begins."""
        torque = np.nan_to_num(signals.torque)
        keep = np.exp(-signals.dt / np.array(self.LAGS))
        late = [torque[0] + follower(torque - torque[0], 1 - k, 0.0, k, 0.0) for k in keep]
        return {Port.WIND_UP: np.stack(late, 1)}


class Droop(Nameless):
    """The torque constant falls with the current: the torque told is c·τ_m·|τ_m| too high      [krause2013]

    Under a steady load it is what friction would be that grows with the square of it, but it gives as it takes.
    """

    name: ClassVar[str] = "droop"
    in_short: ClassVar[str] = "the torque constant falls with the current"
    source: ClassVar[str] = "krause2013"

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading."""
        torque = np.nan_to_num(signals.tau_m)
        return {Port.READS_TAU_M: (torque * np.abs(torque))[:, None]}


class CouplingPlay(Nameless):
    """The load encoder's coupling has play: its reading stays behind by half of it, whichever way it is turned, and
    whatever the torque      [nordin2002]

    Under the load's own friction it is what a loop in the spring or lost motion would be; a locked output shows none.
    """

    name: ClassVar[str] = "coupling_play"
    in_short: ClassVar[str] = "an encoder's coupling has play"
    source: ClassVar[str] = "nordin2002"
    HALF: Final = 2e-5  # rad: gone through within a row of the slow run, so its size tells nothing but the height

    def has_state(self) -> bool:
        """It stays behind."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column in the reading, for half the play of 1 rad."""
        angle = np.ascontiguousarray(np.nan_to_num(signals.theta_l))
        return {Port.READS_THETA_L: ((play(angle, self.HALF) - angle) / self.HALF)[:, None]}

    def plausible(self, fit: Fit) -> bool:
        """It stays behind."""
        return bool(fit.coefficients[0] > 0)


class EvenSpring(Nameless):
    """A spring harder one way than the other: φ loses c·T²      [tuttle1992]

    In a lock test the motor's angle goes with the torque, and any stiffness that changes with that angle does the same.
    """

    name: ClassVar[str] = "even_spring"
    in_short: ClassVar[str] = "the spring is harder one way than the other"
    source: ClassVar[str] = "tuttle1992"

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.WIND_UP: -(np.nan_to_num(signals.torque) ** 2)[:, None]}


class SensorLoop(Nameless):
    """The torque sensor's own hysteresis: it reads Σ c_i·P_{r_i}[T] too much, play operators of the torque [kuhnen2003]

    In a lock test it is a loop in the spring; where the output is free the torque it makes up accelerates no load and
    loads no motor.
    """

    name: ClassVar[str] = "sensor_loop"
    in_short: ClassVar[str] = "the torque sensor has hysteresis"
    source: ClassVar[str] = "kuhnen2003"
    remembers: ClassVar[bool] = True
    WIDTHS: Final = (0.5, 1.5, 4.0, 10.0, 25.0)  # N·m, half: from the swing of a slow run to that of a lock test

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where there is such a sensor."""
        return ((),) if "tau_l" in reach.has else ()

    def has_state(self) -> bool:
        """A loop."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """What each play stays behind by."""
        torque = np.ascontiguousarray(np.nan_to_num(signals.torque))
        return {Port.READS_TAU_L: np.stack([torque - play(torque, width) for width in self.WIDTHS], 1)}


class SensorWaves(Nameless):
    """The torque sensor feels the wave generator: it reads waves of the motor's angle too much      [taghirad1999]

    The motor's torque has an Nth of them left over, as if it cogged; the load's inertia knows of none.
    """

    name: ClassVar[str] = "sensor_waves"
    in_short: ClassVar[str] = "the torque sensor feels the wave generator"
    source: ClassVar[str] = "taghirad1999"
    ORDERS: Final = (1, 2, 4)  # of the motor: an eccentricity, the two lobes and their square

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where there is such a sensor."""
        return ((),) if "tau_l" in reach.has else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order in the reading."""
        return {Port.READS_TAU_L: np.concatenate([wave(k * signals.theta_m) for k in self.ORDERS], 1)}


@dataclass(frozen=True)
class Confounder:
    """A law, what it is taken for, the coordinate it lives in, and whether it is searched for by itself as well: not
    one that a friction of the load would be taken for."""

    effect: Effect
    mimics: frozenset[str]
    coordinate: str
    sentence: str
    searched: bool = True


CONFOUNDERS: Final = {
    "creep": Confounder(
        Creep(),
        frozenset({"hysteretic_stiffness"}),
        "memory",
        "A part of the wind-up follows the torque seconds late, as creep does; a loop that does not depend on the rate "
        "explains less, and no effect of the library explains it.",
    ),
    "coupling_play": Confounder(
        CouplingPlay(),
        frozenset({"hysteretic_stiffness", "lost_motion"}),
        "direction",
        "The load angle stays behind by the same whichever way the motor turns and whatever the torque, as an encoder "
        "does whose coupling has play; a loop in the spring explains less, and no effect of the library explains it.",
    ),
    "sensor_loop": Confounder(
        SensorLoop(),
        frozenset({"hysteretic_stiffness"}),
        "memory",
        "The torque that is read stays behind the torque there is by more the longer it has swung, as a sensor with "
        "hysteresis does; a loop in the spring explains less, and no effect of the library explains it.",
        searched=False,
    ),
    "sensor_waves": Confounder(
        SensorWaves(),
        frozenset({"cogging_torque"}),
        "motor_angle",
        "The torque sensor reads waves of the motor's angle that no inertia of the load goes with, as gauges do that "
        "feel the wave generator; cogging of the motor explains less, and no effect of the library explains it.",
        searched=False,
    ),
    "even_spring": Confounder(
        EvenSpring(),
        frozenset({"angle_dependent_stiffness"}),
        "load",
        "The gear winds up less one way than the other, with the square of the torque; a stiffness that changes with "
        "the angle explains no more, and no effect of the library is so.",
    ),
    "droop": Confounder(
        Droop(),
        frozenset({"load_dependent_friction"}),
        "load",
        "The motor's torque falls short of what is told, with the square of it, forth and back alike: its torque "
        "constant may droop. No effect of the library explains it.",
    ),
}


def with_confounders(s: Solution, runs: Sequence[int], covered: Reach) -> Solution:
    """With the confounder in the place of its look-alike, wherever it explains more of the fitted runs, or as much with
    fewer coefficients."""
    n = sum(s.design.y[key].size / s.design.eq.noise.kappa[key[1]] for key in s.keys)
    for confounder in CONFOUNDERS.values():
        mine = [i for i, term in enumerate(s.design.terms) if term.name in confounder.mimics]
        if mine and confounder.effect.shapes(covered):
            other = fit(extended(reduced(s.design, mine), Term(confounder.effect, ()), runs))
            saved = (s.design.size - other.design.size) * np.log(n)
            s = other if other.gain + saved > s.gain else s
    return s


def of_the_library(ranking: Sequence[Scored]) -> tuple[Scored, ...]:
    """A ranking without confounders."""
    return tuple(r for r in ranking if r.term.name not in CONFOUNDERS)


def confounders_in(s: Solution) -> list[Confounder]:
    """The confounders in a model."""
    return [CONFOUNDERS[term.name] for term in s.design.terms if term.name in CONFOUNDERS]
