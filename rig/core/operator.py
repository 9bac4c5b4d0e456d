"""What a person does to the rig between runs: hang a weight, fit the lock pin, set the depth. Never taken on trust.

A `Change` is asked for, an `Operator` makes it (a person told in words, or the twin's own hand), and the sensors then
have to show it. `Rigging` is what the rig is like when all changes so far have been made.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any


@dataclass(frozen=True)
class Rigging:
    """How the rig is set up by hand."""

    tau_ext: float = 0.0  # N·m on the load, positive drives it forward
    output_locked: bool = False
    depth_mm: float = 0.0  # wave-generator depth from its reference
    assembly: int = 1  # counts re-assemblies

    def conditions(self) -> dict[str, Any]:
        """For the manifest's `conditions`."""
        return {
            "tau_ext": self.tau_ext,
            "output_locked": self.output_locked,
            "depth_mm": self.depth_mm,
            "assembly": self.assembly,
        }


@dataclass(frozen=True)
class Change(ABC):
    """One thing to do by hand, with the motor torque-free."""

    @abstractmethod
    def words(self) -> str:
        """What to tell the operator, an imperative without a full stop."""

    @abstractmethod
    def applied(self, rigging: Rigging) -> Rigging:
        """What the rig is like afterwards."""


@dataclass(frozen=True)
class HangWeight(Change):
    """A dead weight on the output's pulley; 0 takes it off."""

    tau_ext: float  # N·m, positive drives the load forward

    def words(self) -> str:
        """Which torque, which way."""
        if self.tau_ext == 0:
            return "take the weight off the output"
        way = "forward" if self.tau_ext > 0 else "backward"
        return f"hang {abs(self.tau_ext):g} N·m on the output, pulling {way}"

    def applied(self, rigging: Rigging) -> Rigging:
        """With that weight."""
        return replace(rigging, tau_ext=self.tau_ext)


@dataclass(frozen=True)
class LockOutput(Change):
    """The lock pin in."""

    def words(self) -> str:
        """Fit it."""
        return "fit the lock pin of the output"

    def applied(self, rigging: Rigging) -> Rigging:
        """Locked."""
        return replace(rigging, output_locked=True)


@dataclass(frozen=True)
class FreeOutput(Change):
    """The lock pin out."""

    def words(self) -> str:
        """Remove it."""
        return "remove the lock pin of the output"

    def applied(self, rigging: Rigging) -> Rigging:
        """Free."""
        return replace(rigging, output_locked=False)


@dataclass(frozen=True)
class Reassemble(Change):
    """Take the wave generator out and fit it again, `depth_mm` from its reference depth."""

    depth_mm: float = 0.0

    def words(self) -> str:
        """To which depth."""
        return f"take the wave generator out and fit it again at a depth of {self.depth_mm:+g} mm from its reference"

    def applied(self, rigging: Rigging) -> Rigging:
        """One assembly further."""
        return replace(rigging, depth_mm=self.depth_mm, assembly=rigging.assembly + 1)


@dataclass(frozen=True)
class ClearFault(Change):
    """Look at a rig that tripped, and take responsibility for going on: nothing re-enables by itself."""

    why: str = ""

    def words(self) -> str:
        """What happened, what to look at."""
        return f"the rig tripped: {self.why}; see that it is whole and free to turn, then clear the fault"

    def applied(self, rigging: Rigging) -> Rigging:
        """As before."""
        return rigging


class Operator(ABC):
    """Whoever makes changes by hand."""

    begins_anew: bool = False  # each time it is connected the rig is as made: a twin within the process

    @abstractmethod
    def make(self, change: Change) -> None:
        """Have it done; returns when it is said to be done. Raises NotReady when it cannot be."""

    def remake(self, change: Change) -> None:
        """Do once more, where the rig begins anew, what was shown to be done; nobody is asked. Raises as `make`."""
        self.make(change)
