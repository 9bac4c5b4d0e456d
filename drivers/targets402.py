"""Setpoints of a CiA 402 drive's cyclic modes: from SI to the numbers of RPDO 1, within the limits      [cia402]"""

from __future__ import annotations

import math
from typing import NamedTuple

from drivers.mapping import Mapped
from drivers.profile402 import signed32
from drivers.wiring import Place
from rig.core.sample import Mode
from rig.core.units import TURN

PERMILLE = 1000.0
EXACT = 1.0 + 1e-12  # 0.6 N·m of 3 N·m are 200 per mille, and 199.99999999999997 in binary
MISSED = 10.0  # periods: a position may move on by as many, when cycles were missed


class Target(NamedTuple):
    """A cyclic synchronous mode, and the object its setpoint is written to."""

    number: int  # in 6060h
    supported: int  # its bit in 6502h
    object: Mapped

    @property
    def mapped(self) -> tuple[Mapped, Mapped]:
        """RPDO 1: controlword and target."""
        return Mapped(0x6040, 0, 16, "H"), self.object


TARGETS = {
    Mode.TORQUE: Target(10, 1 << 9, Mapped(0x6071, 0, 16, "h")),  # per mille of the rated torque
    Mode.VELOCITY: Target(9, 1 << 8, Mapped(0x60FF, 0, 32, "i")),  # in the unit of 60A9h
    Mode.POSITION: Target(8, 1 << 7, Mapped(0x607A, 0, 32, "i")),  # increments
}


class Scale:
    """What a setpoint is in a frame; `position` [rad] is the last one that was asked for."""

    def __init__(self, place: Place) -> None:
        self._place = place
        self._direction = place.options.get("direction", 1)
        self._step = TURN / place.counts_per_turn  # rad
        self.speed_unit = 1.0  # of the drive, per rad/s
        self.position = 0.0  # rad
        self.clipped = False  # the last one did not fit the limits

    def rest(self, mode: Mode) -> int:
        """The number that asks for nothing: no torque, rest, the angle it has."""
        return self._counts(self.position) if mode is Mode.POSITION else 0

    def within(self, mode: Mode, asked: float, passed: float) -> tuple[int, float]:
        """The number for the frame and what it means in SI, as near to `asked` as the limits allow.

        `passed` s since the setpoint before: a position may move on by what the speed limit allows in that time.
        """
        place = self._place
        match mode:
            case Mode.TORQUE:
                tau = self._clip(asked if math.isfinite(asked) else 0.0, 0.0, place.torque_limit)
                permille = int(tau / place.torque_rated * PERMILLE * EXACT)  # towards zero: never more than was asked
                return self._direction * permille, permille / PERMILLE * place.torque_rated
            case Mode.VELOCITY:
                omega = self._clip(asked if math.isfinite(asked) else 0.0, 0.0, place.speed_limit)
                speed = int(omega * self.speed_unit)
                return self._direction * speed, speed / self.speed_unit
            case Mode.POSITION:
                most = place.speed_limit * min(max(passed, place.period), MISSED * place.period)
                self.position = self._clip(asked if math.isfinite(asked) else self.position, self.position, most)
                return self._counts(self.position), round(self.position / self._step) * self._step

    def _clip(self, asked: float, middle: float, most: float) -> float:
        self.clipped = not abs(asked - middle) <= most
        return min(max(asked, middle - most), middle + most)

    def _counts(self, theta: float) -> int:
        return signed32(self._direction * round(theta / self._step))
