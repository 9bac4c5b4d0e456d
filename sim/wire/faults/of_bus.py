"""Faults of the wire: tampering with frames, cables, stations that should not be there."""

from __future__ import annotations

import math
from typing import final

from rig.core.errors import UsageError
from sim.wire.bus import Bus, Port, Tamper
from sim.wire.faults.words import Number, number
from sim.wire.frame import ERROR, EXTENDED, Frame
from sim.wire.tampers import Delay, Drop, Duplicate, Reorder, Resize

GONE = 0.01  # s after its last frame a station that should not be there is no longer there
BUS_OFF = Frame(ERROR | 0x40, bytes(8))  # CAN_ERR_BUSOFF of linux/can/error.h


@final
class BusFaults:
    """Of the wire: tampering with frames, cables, stations that should not be there."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus
        self._ghosts: list[Port] = []

    def heal(self) -> None:
        """All sound."""
        self._bus.tampers = []
        for port in self._bus.ports:
            port.reconnect()
        for ghost in self._ghosts:
            ghost.leave()
        self._ghosts = []

    def standing(self) -> list[str]:
        """What is not sound: the cable of a node, or of a host, that is out; a station more; tampering that goes on."""
        out = [f"cut station={port.name}" for port in self._bus.ports if not port.connected]
        sending = [f"send: {len(self._ghosts)} strange station(s) on the bus"] if self._ghosts else []
        return [*out, *sending, *(str(tamper) for tamper in self._bus.tampers if not tamper.done)]

    def drop(self, identifier: Number = None, count: float = math.inf) -> None:
        """Frames are lost"""
        self._tamper(Drop(_which(identifier), count))

    def delay(self, seconds: float, identifier: Number = None, count: float = math.inf) -> None:
        """Frames arrive late"""
        self._tamper(Delay(_which(identifier), float(seconds), count))

    def duplicate(self, identifier: Number = None, count: float = math.inf) -> None:
        """Frames arrive twice"""
        self._tamper(Duplicate(_which(identifier), count))

    def reorder(self, identifier: Number = None, count: float = math.inf) -> None:
        """Frames change places in pairs"""
        self._tamper(Reorder(_which(identifier), count))

    def resize(self, size: int, identifier: Number = None, count: float = math.inf) -> None:
        """Frames are torn off or filled up to `size` bytes"""
        if not 0 <= size <= 8:
            raise UsageError(f"a frame of {size} bytes: expected 0 to 8")
        self._tamper(Resize(_which(identifier), size, count))

    def cut(self, station: str = "hosts", keeps: bool = False) -> None:
        """The cable of a station is out; keeps: what it sends meanwhile goes out when it is back"""
        for port in self._stations(station):
            port.disconnect(keeps)

    def bus_off(self, station: str = "hosts") -> None:
        """A station's controller goes bus-off: an error frame as Linux has them, then silence until it joins again"""
        for port in self._stations(station):
            port.receive(BUS_OFF, self._bus.agenda.now)
            port.disconnect(keeps=False)

    def join(self, station: str = "hosts") -> None:
        """The cable is back"""
        for port in self._stations(station):
            port.reconnect()

    def send(
        self,
        identifier: int | str,
        data: str = "",
        every: float = 0.0,
        count: float = 1,
        extended: bool = False,
    ) -> None:
        """Somebody else sends a frame: once or `count` times `every` s; a babbler, a second master, a double"""
        try:
            frame = Frame(number(identifier) | (EXTENDED if extended else 0), bytes.fromhex(data))
        except ValueError:
            raise UsageError(f"data '{data}': expected hexadecimal digits in pairs") from None
        if len(frame.data) > 8:
            raise UsageError(f"{len(frame.data)} data bytes: a CAN frame has 8 at most")
        if count > 1 and not every > 0.0:
            raise UsageError(f"every {every:g} s: expected more than 0 s between {count:g} frames")
        ghost = self._bus.attach("ghost", lambda frame, t: None)
        self._ghosts.append(ghost)
        self._repeat(ghost, frame, every, count)

    def babble(self, identifier: int | str = 0, every: float = 50e-6, seconds: float = 1.0) -> None:
        """A station that never stops: by default it has a frame ready whenever the bus is free, before all others"""
        self.send(identifier, "aaaaaaaaaaaaaaaa", every, max(1.0, seconds / every))

    def second_master(self, node: int = 1, every: float = 0.005, count: float = 200) -> None:
        """Another program reads 1000h of a node by SDO all the time: its answers mix with ours"""
        self.send(0x600 + node, "4000100000000000", every, count)

    def _repeat(self, ghost: Port, frame: Frame, every: float, left: float) -> None:
        if ghost not in self._ghosts:
            return
        if not ghost.queue:  # who does not get the bus does not queue either
            ghost.send(frame)
        if left > 1:
            self._bus.agenda.after(every, lambda: self._repeat(ghost, frame, every, left - 1))
        else:
            self._bus.agenda.after(GONE, lambda: self._retire(ghost))

    def _retire(self, ghost: Port) -> None:
        if ghost not in self._ghosts:
            return
        if ghost.queue:  # it has not had the bus yet
            self._bus.agenda.after(GONE, lambda: self._retire(ghost))
            return
        self._ghosts.remove(ghost)
        ghost.leave()

    def _tamper(self, tamper: Tamper) -> None:
        self._bus.tampers.append(tamper)

    def _stations(self, name: str) -> list[Port]:
        ports = self._bus.ports
        found = [p for p in ports if p.name == name or (name == "hosts" and not p.name.startswith("node"))]
        if not found and name == "hosts":
            raise UsageError("no host is on the bus, which could be cut off")
        if not found:
            raise UsageError(f"no station '{name}'; expected hosts, {', '.join(port.name for port in ports)}")
        return found


def _which(identifier: Number) -> int | None:
    return None if identifier is None else number(identifier)
