"""What every CANopen node does: NMT, SYNC, SDO, PDOs, storing, rebooting      [cia301]

Watching each other is in `watch`, errors in `emergency`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import NamedTuple

from sim.wire.bus import Bus
from sim.wire.emergency import COMMUNICATION, HEARTBEAT_LOST, RPDO_LATE, RPDO_SHORT, Emergencies
from sim.wire.frame import Frame
from sim.wire.objects import TEXT, U8, U32, Abort, AbortCode, Entry, Objects, Value
from sim.wire.pdo import NO_REMOTE, PdoDefault, Rpdo, Tpdo
from sim.wire.sdo import SdoServer
from sim.wire.watch import State, Watch

BOOT = 0.05  # s from reset to the boot-up message
SDO_TURNROUND = 1e-3  # s a node takes to answer; real ones take 1 to 10 ms
SAVE, LOAD = 0x65766173, 0x64616F6C  # "save" and "load" as U32
VENDOR = 0x00000000  # no vendor has number 0: nobody mistakes this for a device
KEPT_OUT = (0x1010, 0x1011)  # not stored: storing itself


class NodeIdentity(NamedTuple):
    """1000, 1008, 1018: profile number and additional information, name, product code, serial number."""

    device_type: int
    name: str
    product: int
    serial: int


class Node(ABC):
    """A node on the bus; a profile adds its objects in `furnish` and its reactions in the `on_` methods."""

    profile_defaults: tuple[Mapping[int, PdoDefault], Mapping[int, PdoDefault]]  # RPDOs and TPDOs by number from 0
    watch: Watch
    rpdos: dict[int, Rpdo]
    tpdos: dict[int, Tpdo]

    def __init__(self, bus: Bus, node_id: int, identity: NodeIdentity) -> None:
        self.bus, self.agenda, self.id, self.identity = bus, bus.agenda, node_id, identity
        self.port = bus.attach(f"node {node_id}", self._receive)
        self.sdo_turnround = SDO_TURNROUND
        self.stored: dict[tuple[int, int], Value] = {}
        self._life = 0  # how often it has been switched on; what an earlier life had under way is not sent
        self.power_up()

    @property
    def state(self) -> State:
        """NMT state."""
        return self.watch.state

    # ---- life ----

    def power_up(self) -> None:
        """Start from nothing but the stored values; the boot-up message follows."""
        if self._life:
            self.watch.rest()
            self._pdos_rest()
        self._life += 1
        self.objects = Objects()
        self._handlers: dict[int, Callable[[bytes], None]] = {}
        self.errors = Emergencies(self.objects, self.id, self._say)
        self.watch = Watch(self.objects, self.agenda, self.id, self._send, self._rebuild, self._lost)
        self._communication_objects(self.objects)
        self.furnish(self.objects)
        self._pdos(*self.profile_defaults)
        for (index, sub), value in self.stored.items():
            self.objects.find(index, sub).value = value
        for pdo in (*self.rpdos.values(), *self.tpdos.values()):
            pdo.refresh()
        self._sdo = SdoServer(self.objects, self._answer)
        life = self._life
        self.agenda.after(BOOT, lambda: self._boot() if life == self._life else None)

    def leave(self) -> None:
        """Gone for good: nothing more is sent or heard."""
        self._life += 1
        self.watch.rest()
        self._pdos_rest()
        self.port.leave()

    def _boot(self) -> None:
        self.watch.boot()
        self._rebuild()

    @abstractmethod
    def furnish(self, objects: Objects) -> None:
        """Add the profile's objects, as after power-up."""

    def on_state(self) -> None:  # noqa: B027 - most nodes do nothing then
        """The NMT state has changed."""

    def on_lost(self, code: int) -> None:
        """The host has gone: emergency `code` says how it was noticed."""
        self.errors.report(code, COMMUNICATION)

    def event(self, entry: Entry) -> None:
        """The value of `entry` changed of itself: PDOs that carry it on events go out."""
        if self.state is State.OPERATIONAL:
            for tpdo in self.tpdos.values():
                tpdo.event(entry)

    # ---- the dictionary ----

    def _communication_objects(self, o: Objects) -> None:
        who = self.identity
        o.add(0x1000, Entry(U32, who.device_type, "r"))
        self.sync_cob = o.add(0x1005, Entry(U32, 0x80, write=lambda value: self.agenda.after(0.0, self._rebuild)))
        o.add(0x1008, Entry(TEXT, who.name.encode("ascii"), "r"))
        o.add(0x1009, Entry(TEXT, b"simulated", "r"))
        o.add(0x100A, Entry(TEXT, b"hdrig twin 1", "r"))
        o.record(0x1010, {1: Entry(U32, 0, read=lambda: 1, write=self._store)})
        o.record(0x1011, {1: Entry(U32, 0, read=lambda: 1, write=self._forget)})
        numbers = enumerate((VENDOR, who.product, 1, who.serial), 1)
        o.record(0x1018, {sub: Entry(U32, number, "r") for sub, number in numbers})
        o.add(0x1019, Entry(U8))
        self.after_error = Entry(U8, 1)  # 0 pre-operational, 1 no change, 2 stopped
        o.record(0x1029, {1: self.after_error})

    def _pdos(self, receive: Mapping[int, PdoDefault], transmit: Mapping[int, PdoDefault]) -> None:
        o, agenda, changed = self.objects, self.agenda, self._rebuild
        self.rpdos = {
            n: Rpdo(o, n, default.of_node(self.id), agenda, changed, self._rpdo_late, self._rpdo_short)
            for n, default in receive.items()
        }
        self.tpdos = {
            n: Tpdo(o, n, default.of_node(self.id | NO_REMOTE), agenda, changed, self._send_pdo)
            for n, default in transmit.items()
        }

    def _pdos_rest(self) -> None:
        for pdo in (*self.rpdos.values(), *self.tpdos.values()):
            pdo.rest()

    def _store(self, value: float) -> None:
        if value != SAVE:
            raise Abort(AbortCode.GENERAL)
        self.stored = {
            (index, sub): entry.value
            for index, sub, entry in self.objects
            if entry.writable and entry.read is None and index not in KEPT_OUT
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
            **self.watch.handlers(),
            **{rpdo.identifier: self._taking(rpdo) for rpdo in self.rpdos.values() if rpdo.on},
        }

    def _receive(self, frame: Frame, t: float) -> None:
        handle = self._handlers.get(frame.identifier)
        if handle is not None and self.state is not State.INITIALISING:
            handle(frame.data)

    def _send(self, identifier: int, data: bytes) -> None:
        self.port.send(Frame(identifier, data))

    def _say(self, identifier: int, data: bytes) -> None:
        """What only nodes that are up and not stopped say."""
        if self.state not in (State.STOPPED, State.INITIALISING):
            self._send(identifier, data)

    def _nmt(self, data: bytes) -> None:
        if len(data) != 2 or data[1] not in (0, self.id):
            return
        match data[0]:
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
        self.watch.state = state
        self._pdos_rest()
        if state is State.OPERATIONAL:
            for tpdo in self.tpdos.values():
                tpdo.begin()
        self.on_state()

    def _sync(self, data: bytes) -> None:
        if self.state is State.OPERATIONAL:
            for rpdo in self.rpdos.values():
                rpdo.sync()
            for tpdo in self.tpdos.values():
                tpdo.sync()

    def _sdo_request(self, data: bytes) -> None:
        if self.state is not State.STOPPED:
            self._sdo.request(data)

    def _answer(self, data: bytes) -> None:
        life = self._life
        frame = Frame(0x580 + self.id, data)
        self.agenda.after(self.sdo_turnround, lambda: self.port.send(frame) if life == self._life else None)

    def _taking(self, rpdo: Rpdo) -> Callable[[bytes], None]:
        return lambda data: rpdo.receive(data) if self.state is State.OPERATIONAL else None

    def _send_pdo(self, identifier: int, data: bytes) -> None:
        if self.state is State.OPERATIONAL:
            self._send(identifier, data)

    def _rpdo_short(self) -> None:
        self.errors.report(RPDO_SHORT, COMMUNICATION)

    def _rpdo_late(self) -> None:
        if self.state is State.OPERATIONAL:
            self.on_lost(RPDO_LATE)

    def _lost(self) -> None:
        self.on_lost(HEARTBEAT_LOST)
        match self.after_error.number:
            case 0 if self.state is State.OPERATIONAL:
                self._enter(State.PRE_OPERATIONAL)
            case 2:
                self._enter(State.STOPPED)
