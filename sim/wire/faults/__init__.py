"""Everything that can go wrong while it runs, as verbs of the command channel.

Identifiers are 11 bits (385 or "0x181"); a frame of 29 bits is said with extended = true. Times are in seconds.
A device is "drive", "encoder" or "torque", for what it measures also "serial_torque" or "qsb"; a line is "torque",
"qsb" or "slcan"; a station is a name from `status`, "hosts" for all that are not nodes. `heal` ends all faults of bus,
lines and sensors; what a node went through stays. `faults` lists those that stand, read from where they act: one that
has used up its count, or was taken back, is not there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rig.core.errors import UsageError
from sim.wire.assembly import Assembly
from sim.wire.control import Verb
from sim.wire.faults.of_bus import BusFaults
from sim.wire.faults.of_lines import LineFaults
from sim.wire.faults.of_nodes import NodeFaults
from sim.wire.faults.of_sensors import Sensor, SensorFaults
from sim.wire.pty import SerialLine
from sim.wire.reactor import Reactor

LONGEST_STALL = 10.0  # s
NO_VERBS = ("heal", "standing", "choices")  # of a group


def fault_verbs(
    assembly: Assembly, reactor: Reactor, lines: Mapping[str, SerialLine], sensors: Mapping[str, Sensor]
) -> dict[str, Verb]:
    """All of them; `lines` and `sensors` are those of the serial devices there are."""
    groups = (BusFaults(assembly.bus), NodeFaults(assembly), LineFaults(lines), SensorFaults(assembly, sensors))
    found: dict[str, Verb] = {}
    for group in groups:
        found |= {
            name: getattr(group, name) for name in dir(group) if not name.startswith("_") and name not in NO_VERBS
        }

    def heal() -> None:
        """End all faults of bus, lines and sensors"""
        for group in groups:
            group.heal()

    def faults() -> dict[str, Any]:
        """The faults that stand, as they are asked for"""
        return {"faults": [fault for group in groups for fault in group.standing()]}

    def stall(seconds: float) -> None:
        """The twin gets no processor for so long"""
        if not 0.0 <= seconds <= LONGEST_STALL:
            raise UsageError(f"a stall of {seconds:g} s: expected 0 to {LONGEST_STALL:g} s")
        reactor.stall(seconds)

    return {**found, "heal": heal, "faults": faults, "stall": stall}
