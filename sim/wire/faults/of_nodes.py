"""Faults of nodes: reboot, emergency, lost enable, wrong numbers in the dictionary, slow answers."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import final

from rig.core.errors import UsageError
from sim.wire.assembly import Assembly
from sim.wire.cia404 import TorqueTransducer
from sim.wire.cia406 import AbsoluteEncoder
from sim.wire.faults.words import named, number
from sim.wire.node import SDO_TURNROUND, Node
from sim.wire.objects import Abort, Entry

DOUBLES: dict[str, type[AbsoluteEncoder | TorqueTransducer]] = {"encoder": AbsoluteEncoder, "torque": TorqueTransducer}


@final
class NodeFaults:
    """Of a node: reboot, emergency, lost enable, wrong numbers in its dictionary, slow answers."""

    def __init__(self, assembly: Assembly) -> None:
        self._assembly = assembly
        self._doubles: list[Node] = []

    def heal(self) -> None:
        """No doubles, no slow answers, inputs of the drive as they should be."""
        for node in self._doubles:
            node.leave()
        self._doubles = []
        drive, encoder, torque = self._assembly.drive, self._assembly.encoder, self._assembly.torque
        for node in (drive, encoder, torque):
            node.sdo_turnround = SDO_TURNROUND
        drive.mode_stuck = drive.incurable = False
        if drive.sto_active:
            drive.sto(False, False)

    def choices(self) -> dict[str, Iterable[str]]:
        """What a device may be."""
        return {"device": self._nodes()}

    def standing(self) -> list[str]:
        """What `heal` would end."""
        drive = self._assembly.drive
        slow = [
            f"slow_sdo device={name} seconds={node.sdo_turnround:g}"
            for name, node in self._nodes().items()
            if node.sdo_turnround != SDO_TURNROUND
        ]
        flags = {
            "sto active=true": drive.sto_active,
            "mode_stuck active=true": drive.mode_stuck,
            "trip again=true": drive.incurable,
        }
        doubles = [f"double: node {node.id} is there twice" for node in self._doubles]
        return [*(name for name, there in flags.items() if there), *slow, *doubles]

    def reboot(self, device: str) -> None:
        """Its power fails for a moment: mapping and, without a battery, position are lost"""
        self._node(device).power_up()

    def double(self, device: str) -> None:
        """A second node of the same number, as when somebody forgot to set it: encoder or torque"""
        a = self._assembly
        make = named(DOUBLES, device, "device that can be doubled")
        self._doubles.append(make(a.bus, self._node(device).id, a.world))

    def emergency(self, device: str, code: int | str, register: int = 0x80) -> None:
        """It sends an EMCY and goes on"""
        self._node(device).errors.report(number(code), register)

    def trip(self, code: int | str, again: bool = False) -> None:
        """The drive's own protection acts; again: it comes back when it is reset"""
        self._assembly.drive.incurable = bool(again)
        self._assembly.drive.fault(number(code))

    def sto(self, active: bool = True, fault: bool = False) -> None:
        """Safe torque off, as a loss of enable or as a fault"""
        self._assembly.drive.sto(bool(active), bool(fault))

    def mode_stuck(self, active: bool = True) -> None:
        """6061 no longer follows 6060"""
        self._assembly.drive.mode_stuck = bool(active)

    def put(self, device: str, index: int | str, value: float, sub: int = 0) -> None:
        """Another tool writes an object: scale, unit, limit, mapping; read-only ones too"""
        entry = self._entry(device, index, sub)
        try:
            data = entry.kind.pack(value)
            if entry.writable:
                entry.accept(data)
        except (Abort, struct.error) as why:
            raise UsageError(f"{device} refuses {value:g} in {index}:{sub}: {why}") from None
        entry.value, entry.read = value, None if not entry.writable else entry.read

    def position(self, offset: int) -> None:
        """The motor's position register is `offset` counts further from now on: another zero, or close to a wrap"""
        self._assembly.drive.motor.offset += int(offset)

    def slow_sdo(self, device: str, seconds: float) -> None:
        """SDO answers take so long"""
        self._node(device).sdo_turnround = float(seconds)

    def _nodes(self) -> dict[str, Node]:
        a = self._assembly
        return {"drive": a.drive, "encoder": a.encoder, "torque": a.torque}

    def _node(self, device: str) -> Node:
        return named(self._nodes(), device, "device")

    def _entry(self, device: str, index: int | str, sub: int) -> Entry:
        try:
            return self._node(device).objects.find(number(index), sub)
        except Abort as abort:
            raise UsageError(f"{device} has no object {index}:{sub}: {abort}") from None
