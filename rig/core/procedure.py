"""A procedure is a generator: one `yield` is one tick. The same one runs on the twin, over the wire and on the rig."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Generator
from dataclasses import dataclass, field
from typing import Any, ClassVar

from rig.core.drivetrain import Drivetrain
from rig.core.gains import Gains
from rig.core.kinds import Regime
from rig.core.sample import Sample, Setpoint
from rig.core.units import TURN

Steps = Generator[Setpoint, Sample, Any]
"""Receives the newest sample, yields what to ask of the drive, once a tick; what it returns is the run's finding."""


@dataclass(frozen=True)
class Envelope:
    """What a procedure will ask for at most. The dry run prints it, the guard holds the run to it."""

    duration: float  # s of rig time
    travel: float  # rad of motor angle, either way from where the run starts
    speed: float  # rad/s of the motor, nominal
    torque: float  # N·m, motor side
    coupled: bool = True  # the load must follow the motor: trips when the gear seems to twist or slip
    shaft_torque: float = math.inf  # N·m at the torque sensor, either way; inf: nothing below the bench's own limit
    loop: float = 0.0  # rad/s, how fast a position loop stiffer than the bench's answers; 0: none is
    loop_by: str = ""  # in words, what makes it so fast and the most that may be
    reserve: str = ""  # in words, what of speed and shaft torque (output locked: of that alone) nobody asked for


@dataclass(frozen=True)
class Setting:
    """What the loop tells a procedure about the rig it runs on."""

    period: float  # s, one tick
    ratio: float  # gear ratio N
    control: Gains
    drivetrain: Drivetrain  # as declared
    note: Callable[[str], None] = field(default=lambda text: None)  # a line in events.jsonl
    stiffness: float = math.nan  # N·m/rad at the output, declared, of the whole path


class Procedure(ABC):
    """One experiment: parameters in the fields (all with units and defaults), told step by step in `steps`."""

    name: ClassVar[str]  # as in the manifest, with underscores: one of `rig.core.kinds`
    needs: ClassVar[tuple[str, ...]]  # channels without which it is refused: a test against NaN is silently false
    output_locked: ClassVar[bool] = False  # what the output must be like
    closes_loop: ClassVar[bool] = True  # needs the sign-and-scale proof first
    has_reference: ClassVar[bool] = False  # an angle throughout, which a drive that closes the loop itself can be given
    label: ClassVar[str] = ""  # what people call it where `name` is "other"
    regime: ClassVar[Regime] = Regime.OTHER  # said where `name` is "other"; else `rig.core.kinds` has it
    answers: ClassVar[bool] = False  # it says itself what it found, in a sentence: no analysis follows
    checks: ClassVar[bool] = False  # looks at the rig, not at the gear

    @abstractmethod
    def envelope(self, setting: Setting) -> Envelope:
        """What it will ask for at most."""

    @abstractmethod
    def steps(self, setting: Setting) -> Steps:
        """The experiment. Primed with `next`, then given one sample a tick."""

    def to_rest(self, setting: Setting) -> Steps | None:
        """How a controlled stop (category 1) ends it from wherever it is. None: the motor is braked, which will do
        wherever nothing stays wound up behind it.
        """
        return None

    def remarks(self, setting: Setting) -> list[str]:
        """What a person should know before it starts, one sentence each: stored energy, how it is let out."""
        return []

    def announcement(self, setting: Setting) -> str:
        """What is said before it moves the motor, at most how far and with which torque; "" of one that gives none."""
        most = self.envelope(setting)
        if not most.torque:
            return ""
        return (
            f"the motor is about to turn: {self.title()}, at most {most.travel / TURN:.1f} turns either way and "
            f"{most.torque:g} N·m"
        )

    def title(self) -> str:
        """What people call it, with hyphens, as on the command line."""
        return self.label or self.name.replace("_", "-")

    def conditions(self) -> dict[str, Any]:
        """What goes into the manifest's `conditions`."""
        return {"output_locked": self.output_locked}
