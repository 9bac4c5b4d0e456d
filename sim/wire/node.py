"""What every CANopen node does: NMT, heartbeat and guarding, SYNC, EMCY, SDO, PDOs, storing, rebooting      [cia301]"""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from enum import IntEnum
from typing import NamedTuple

from sim.wire.agenda import Timer
from sim.wire.bus import Bus
from sim.wire.frame import REMOTE, Frame
from sim.wire.objects import TEXT, U8, U16, U32, Abort, AbortCode, Entry, Objects, Value
from sim.wire.pdo import NO_REMOTE, OFF, PdoDefault, Rpdo, Tpdo
from sim.wire.sdo import SdoServer

BOOT = 0.05  # s from reset to the boot-up message
SDO_TURNROUND = 1e-3  # s a node takes to answer; real ones take 1 to 10 ms
GENERIC, COMMUNICATION, PROFILE = 0x01, 0x10, 0x20  # bits of the error register 1001
HEARTBEAT_LOST, RPDO_SHORT, RPDO_LATE = 0x8130, 0x8210, 0x8250  # emergency codes
SAVE, LOAD = 0x65766173, 0x64616F6C  # "save" and "load" as U32
HISTORY = 8  # errors kept in 1003
VENDOR = 0x00000000  # no vendor has number 0: nobody mistakes this for a device


class State(IntEnum):
    """NMT states as the heartbeat says them."""

    INITIALISING = 0
    STOPPED = 4
    OPERATIONAL = 5
    PRE_OPERATIONAL = 127


class NodeIdentity(NamedTuple):
    """1000, 1008, 1018: profile number and additional information, name, product code, serial number."""

    device_type: int
    name: str
    product: int
    serial: int


class Node(ABC):
    """A node on the bus; a profile adds its objects in `furnish` and its reactions in the `on_` methods."""

    profile_defaults: tuple[Mapping[int, PdoDefault], Mapping[int, PdoDefault]]  # RPDOs and TPDOs by number from 0

    def __init__(self, bus: Bus, node_id: int, identity: NodeIdentity) -> None:
        self.bus, self.agenda, self.id, self.identity = bus, bus.agenda, node_id, identity
        self.port = bus.attach(f"node {node_id}", self._receive)
        self.sdo_turnround = SDO_TURNROUND
        self.stored: dict[tuple[int, int], Value] = {}
        self._life = 0  # how often it has been switched on; answers of an earlier life are not sent
        self._consumers: dict[int, Timer] = {}
        self.power_up()

    # ---- life ----

    def power_up(self) -> None:
        """Start from nothing but the stored values; the boot-up message follows."""
        self._life += 1
        self._rest()
        self.state = State.INITIALISING
        self._toggle = 0
        self.objects = Objects()
        self._communication_objects(self.objects)
        self.furnish(self.objects)
        receive, transmit = self.profile_defaults
        o, agenda, changed = self.objects, self.agenda, self._rebuild
        self.rpdos = {
            n: Rpdo(o, n, default.of_node(self.id), agenda, changed, self._rpdo_late, self._rpdo_short)
            for n, default in receive.items()
        }
        self.tpdos = {
            n: Tpdo(o, n, default.of_node(self.id | NO_REMOTE), agenda, changed, self._send_pdo)
            for n, default in transmit.items()
        }
        for (index, sub), value in self.stored.items():
            self.objects.find(index, sub).value = value
        for pdo in (*self.rpdos.values(), *self.tpdos.values()):
            pdo.refresh()
        self._sdo = SdoServer(self.objects, self._answer)
        self._heartbeat = Timer(self.agenda, self._beat)
        self._handlers: dict[int, Callable[[Frame], None]] = {}
        life = self._life
        self.agenda.after(BOOT, lambda: self._boot(life))

    def _boot(self, life: int) -> None:
        if life != self._life:
            return
        self.state = State.PRE_OPERATIONAL
        self._rebuild()
        self.port.send(Frame(0x700 + self.id, b"\0"))
        self._set_producer(self.objects.find(0x1017, 0).number)

    def _rest(self) -> None:
        if self._life > 1:
            self._heartbeat.stop()
            for timer in self._consumers.values():
                timer.stop()
            for pdo in (*self.rpdos.values(), *self.tpdos.values()):
                pdo.rest()

    @abstractmethod
    def furnish(self, objects: Objects) -> None:
        """Add the profile's objects, as after power-up."""

    def on_state(self) -> None:  # noqa: B027 - most nodes do nothing then
        """The NMT state has changed."""

    def on_lost(self, code: int) -> None:
        """The host has gone: emergency `code` says how it was noticed."""
        self.emergency(code, COMMUNICATION)

    # ---- the dictionary of the communication profile ----

    def _communication_objects(self, o: Objects) -> None:
        who = self.identity
        o.add(0x1000, Entry(U32, who.device_type, "r"))
        self.error_register = o.add(0x1001, Entry(U8, 0, "r", mappable=True))
        self.history: list[int] = []
        o.add(0x1003, Entry(U8, 0, read=lambda: len(self.history), write=self._clear_history))
        for place in range(HISTORY):
            o.add(0x1003, Entry(U32, 0, "r", read=lambda n=place: self._past_error(n)), place + 1)  # type: ignore[misc]
        self.sync_cob = o.add(0x1005, Entry(U32, 0x80, write=lambda value: self.agenda.after(0.0, self._rebuild)))
        o.add(0x1008, Entry(TEXT, who.name.encode("ascii"), "r"))
        o.add(0x1009, Entry(TEXT, b"simulated", "r"))
        o.add(0x100A, Entry(TEXT, b"hdrig twin 1", "r"))
        o.add(0x100C, Entry(U16))
        o.add(0x100D, Entry(U8))
        o.record(0x1010, {1: Entry(U32, 0, read=lambda: 1, write=self._store)})
        o.record(0x1011, {1: Entry(U32, 0, read=lambda: 1, write=self._forget)})
        self.emcy_cob = o.add(0x1014, Entry(U32, 0x80 + self.id))
        self._consumers = {}
        consumer = Entry(U32, 0, write=self._set_consumer)
        self.consumer = consumer
        o.record(0x1016, {1: consumer})
        o.add(0x1017, Entry(U16, 0, write=self._set_producer))
        o.record(
            0x1018,
            {1: Entry(U32, VENDOR, "r"), 2: Entry(U32, who.product, "r"), 3: Entry(U32, 1, "r"),
             4: Entry(U32, who.serial, "r")},
        )  # fmt: skip
        o.add(0x1019, Entry(U8))
        o.record(0x1029, {1: Entry(U8, 1)})  # after a communication error: 0 pre-operational, 1 no change, 2 stopped

    def _store(self, value: float) -> None:
        if value != SAVE:
            raise Abort(AbortCode.GENERAL)
        self.stored = {
            (index, sub): entry.value
            for index, sub, entry in self.objects
            if entry.writable and entry.read is None and index not in (0x1010, 0x1011)
        }

    def _forget(self, value: float) -> None:
        if value != LOAD:
            raise Abort(AbortCode.GENERAL)
        self.stored = {}

    # ---- frames ----

    def _rebuild(self) -> None:
        """Who handles which identifier."""
        self._handlers = {
            0x000: self._nmt,
            self.sync_cob.number & 0x7FF: self._sync,
            0x600 + self.id: self._sdo_request,
            0x700 + self.id | REMOTE: self._guarded,
        }
        for rpdo in self.rpdos.values():
            if rpdo.on:
                self._handlers[rpdo.identifier] = lambda frame, pdo=rpdo: self._rpdo(pdo, frame)  # type: ignore[misc]
        watched = self.consumer.number >> 16 & 0x7F
        if watched:
            self._handlers[0x700 + watched] = self._heard

    def _receive(self, frame: Frame, t: float) -> None:
        handle = self._handlers.get(frame.identifier)
        if handle is not None and self.state is not State.INITIALISING:
            handle(frame)

    def _nmt(self, frame: Frame) -> None:
        if len(frame.data) != 2 or frame.data[1] not in (0, self.id):
            return
        match frame.data[0]:
            case 0x01:
                self._enter(State.OPERATIONAL)
            case 0x02:
                self._enter(State.STOPPED)
            case 0x80:
                self._enter(State.PRE_OPERATIONAL)
            case 0x81 | 0x82:
                self.power_up()

    def _enter(self, state: State) -> None:
        if state is self.state:
            return
        self.state = state
        for rpdo in self.rpdos.values():
            rpdo.rest()
        for tpdo in self.tpdos.values():
            if state is State.OPERATIONAL:
                tpdo.begin()
            else:
                tpdo.rest()
        self.on_state()

    def _sync(self, frame: Frame) -> None:
        if self.state is State.OPERATIONAL:
            for rpdo in self.rpdos.values():
                rpdo.sync()
            for tpdo in self.tpdos.values():
                tpdo.sync()

    def _sdo_request(self, frame: Frame) -> None:
        if self.state is not State.STOPPED:
            self._sdo.request(frame.data)

    def _answer(self, data: bytes) -> None:
        life = self._life
        frame = Frame(0x580 + self.id, data)
        self.agenda.after(self.sdo_turnround, lambda: self.port.send(frame) if life == self._life else None)

    def _rpdo(self, rpdo: Rpdo, frame: Frame) -> None:
        if self.state is State.OPERATIONAL:
            rpdo.receive(frame.data)

    def _rpdo_short(self) -> None:
        self.emergency(RPDO_SHORT, COMMUNICATION)

    def _rpdo_late(self) -> None:
        if self.state is State.OPERATIONAL:
            self.on_lost(RPDO_LATE)

    def _send_pdo(self, identifier: int, data: bytes) -> None:
        if self.state is State.OPERATIONAL:
            self.port.send(Frame(identifier, data))

    def event(self, entry: Entry) -> None:
        """The value of `entry` changed of itself: PDOs that carry it on events go out."""
        if self.state is State.OPERATIONAL:
            for tpdo in self.tpdos.values():
                tpdo.event(entry)

    # ---- watching each other ----

    def _set_producer(self, milliseconds: float) -> None:
        if milliseconds and self.state is not State.INITIALISING:
            self._heartbeat.start(milliseconds * 1e-3)
        else:
            self._heartbeat.stop()

    def _beat(self) -> None:
        self.port.send(Frame(0x700 + self.id, bytes([self.state])))
        self._set_producer(self.objects.find(0x1017, 0).number)

    def _guarded(self, frame: Frame) -> None:
        self.port.send(Frame(0x700 + self.id, bytes([self._toggle | self.state])))
        self._toggle ^= 0x80
        self._watch(1e-3 * self.objects.find(0x100C, 0).number * self.objects.find(0x100D, 0).number)

    def _set_consumer(self, value: float) -> None:
        for timer in self._consumers.values():
            timer.stop()
        self.consumer.value = int(value)
        self._rebuild()

    def _heard(self, frame: Frame) -> None:
        self._watch(1e-3 * (self.consumer.number & 0xFFFF))

    def _watch(self, limit: float) -> None:
        """The host is alive; expect to hear it again within `limit` s. The first time starts the watch."""
        if limit > 0.0:
            self._consumers.setdefault(0, Timer(self.agenda, self._lost)).start(limit)

    def _lost(self) -> None:
        self.on_lost(HEARTBEAT_LOST)
        match self.objects.find(0x1029, 1).number:
            case 0 if self.state is State.OPERATIONAL:
                self._enter(State.PRE_OPERATIONAL)
            case 2:
                self._enter(State.STOPPED)

    # ---- errors ----

    def emergency(self, code: int, register: int, more: bytes = b"") -> None:
        """Send an EMCY and remember it; `register` are the bits it sets in 1001."""
        self.error_register.value = self.error_register.number | register | GENERIC
        self.history = [code, *self.history][:HISTORY]
        self._send_emergency(code, more)

    def recovered(self) -> None:
        """All errors are gone: EMCY 0000."""
        self.error_register.value = 0
        self._send_emergency(0, b"")

    def _send_emergency(self, code: int, more: bytes) -> None:
        if self.state not in (State.STOPPED, State.INITIALISING) and not self.emcy_cob.number & OFF:
            data = struct.pack("<HB", code, self.error_register.number) + more[:5].ljust(5, b"\0")
            self.port.send(Frame(self.emcy_cob.number & 0x7FF, data))

    def _clear_history(self, value: float) -> None:
        if value:
            raise Abort(AbortCode.VALUE)
        self.history = []

    def _past_error(self, place: int) -> int:
        if place >= len(self.history):
            raise Abort(AbortCode.NO_SUBINDEX)
        return self.history[place]
