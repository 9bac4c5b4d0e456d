"""The readings of a campaign, and which of them a figure asks for."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.kinematic_error.profile import Profile
from rig.analysis.reproduction.model import Model
from rig.analysis.reproduction.reading import Reading

NEAR = 0.015  # of a speed: half of what lies between 300 and 310 rpm
SLOW_ENOUGH = 12.0  # rpm: the paper's 9.6, with what another rig may take for "around 10 rpm"


@dataclass(frozen=True)
class Campaign:
    """Every run read, in the order they were made; the gear identified from some of them."""

    readings: Sequence[Reading]
    model: Model | None
    no_model: str = ""  # why there is none
    unread: tuple[str, ...] = ()  # runs that could not be read, and why

    @property
    def assembly(self) -> int:
        """The one in which the gear was run at speed; else the first."""
        fast = [r.assembly for r in self.readings if r.fast is not None]
        return fast[0] if fast else min((r.assembly for r in self.readings), default=1)

    @property
    def left_out(self) -> tuple[str, ...]:
        """Every run, or speed of one, that does not count, and why."""
        return (*self.unread, *(f"{r.name}: {why}" for r in self.readings for why in r.rejected))

    def pure(self) -> tuple[Reading, KinematicError] | None:
        """The unloaded slow run of most revolutions, in that assembly, and its θ̃_p."""
        found = [(r, k) for r, k in self.slow(self.assembly) if r.tau_ext == 0.0 and k.speed_rpm <= SLOW_ENOUGH]
        return max(found, key=lambda pair: revolutions(pair[1].profile), default=None)

    def slow(self, assembly: int | None = None) -> list[tuple[Reading, KinematicError]]:
        """Every speed of every slow run, of one assembly or of all."""
        here = [r for r in self.readings if assembly is None or r.assembly == assembly]
        return [(r, k) for r in here for k in r.slow]

    def at_speed(self, rpm: float) -> Reading | None:
        """The unloaded run that was meant to turn at `rpm` and came nearest to it; where that is not said of any, the
        one nearest to it of all."""
        found = [r for r in self.readings if r.fast is not None and r.tau_ext == 0.0]
        meant = [r for r in found if r.speed_rpm == rpm]
        near = [r for r in found if math.isnan(r.speed_rpm) and _off(r, rpm) <= NEAR]
        return min(meant or near, key=lambda r: _off(r, rpm), default=None)

    def lock(self) -> Reading | None:
        """The first lock test of which a stiffness was had."""
        return next((r for r in self.readings if r.lock is not None and "lock.windup" in r.lock.curves), None)


def _off(reading: Reading, rpm: float) -> float:
    assert reading.fast is not None
    return abs(reading.fast.speed_rpm / rpm - 1.0)


def revolutions(profile: Profile) -> int:
    """Of both directions."""
    return profile.forward + profile.reverse
