"""Who is on a CAN bus and which serial ports there are. Listens, then asks for identities; energises nothing."""

from __future__ import annotations

from typing import NamedTuple

from serial.tools import list_ports

from drivers import NO_PROFILE
from drivers import cansimple as cs
from drivers.axis import LISTEN, Axis
from drivers.bus import HEARTBEAT, SYNC, Bus
from drivers.node import Node
from drivers.scales402 import MILLI
from rig.core.devices import Identity
from rig.core.errors import NotReady

NODES = range(1, 128)
STRONGEST = 100.0  # N·m of an ampere: no motor makes as much; who says so counts 6076h in µN·m
MICRO = 1e-6  # N·m
PATIENCE = 0.03  # s for an answer; a node that is there takes 1 to 10 ms


class Found(NamedTuple):
    """One node that answered, or one axis that was heard."""

    number: int
    profile: int  # CiA number, low word of 1000h; NO_PROFILE of an ODrive axis
    identity: Identity
    plate: dict[str, float]  # numbers a bench file needs and the device knows

    @property
    def speaks(self) -> str:
        """Its profile, or the protocol that has none, in words."""
        return cs.PROTOCOL if self.profile == NO_PROFILE else f"CiA {self.profile}"


class SerialPort(NamedTuple):
    """One serial port of this machine."""

    path: str
    what: str  # what its adapter says it is
    serial: str  # its adapter's serial number: ports are told apart by it, their names change


def scan(bus: Bus) -> list[Found]:
    """Every node that answers on an open bus, by number. Raises NotReady when the bus is dead.

    Where ODrive axes are heard no CANopen node is asked: the questions are commands to axes 48 to 51.
    """
    if axes := listen(bus):
        bus.protocol = cs.PROTOCOL
        return [Found(number, NO_PROFILE, Axis(bus, number, "axis").open(), {}) for number in axes]
    found = []
    for number in NODES:
        node = Node(bus, number, "node")
        node.open()
        node.sdo.patience(PATIENCE)
        try:
            kind = node.sdo.read_uint(0x1000)
        except NotReady:
            if bus.dead:
                raise NotReady(bus.dead) from None
            continue
        node.sdo.patience(10 * PATIENCE)
        profile = kind & 0xFFFF
        found.append(Found(number, profile, node.identify(profile), plate_of(node, profile)))
    return found


def listen(bus: Bus) -> list[int]:
    """Numbers of the ODrive axes whose heartbeats come; none where CANopen is spoken. Nothing is sent."""
    bus.wait(LISTEN, lambda: False)
    heard = bus.frames
    if any(len(frame.data) <= 1 and (i == SYNC or HEARTBEAT < i < HEARTBEAT + 128) for i, frame in heard.items()):
        return []
    return sorted(
        identifier >> 5
        for identifier, frame in heard.items()
        if identifier & 0x1F == cs.HEARTBEAT
        and frame.number > 1
        and len(frame.data) == 8
        and cs.decode_heartbeat(frame.data).state in cs.STATES
    )


def plate_of(node: Node, profile: int) -> dict[str, float]:
    """Rated torque [N·m] and counts per turn, where the profile has them and the device says them; `rated_step` [N·m]
    where what it says of its current shows that 6076h is not in mN·m.
    """
    if profile == 402:
        told, current = (node.sdo.read_uint(index, default=0) for index in (0x6076, 0x6075))  # mN·m, mA
        micro = current > 0 and told / current > STRONGEST
        increments, turns = (node.sdo.read_uint(0x608F, sub, default=0) for sub in (1, 2))
        counts = increments / turns if increments > 1 and turns else 0.0
        plate = {"torque_rated": told * (MICRO if micro else MILLI), "counts_per_turn": counts}
        return plate | ({"rated_step": MICRO} if micro else {})
    if profile == 406:
        scaled = node.sdo.read_uint(0x6000, default=0) & 1 << 2
        return {"counts_per_turn": float(node.sdo.read_uint(0x6001 if scaled else 0x6501, default=0))}
    return {}


def serial_ports() -> list[SerialPort]:
    """The serial ports the system shows."""
    return [
        SerialPort(port.device, port.description or "", port.serial_number or "")
        for port in sorted(list_ports.comports(), key=lambda p: p.device)
    ]
