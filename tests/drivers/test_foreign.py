"""Devices of other makers: what they lack is done without and said, what they refuse is gone around, or refused."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from typing import Any

import can
import canopen
import pytest

from drivers.bus import Bus as HostBus
from drivers.cia402 import Cia402
from drivers.cia404 import Cia404
from drivers.cia406 import POSITION, Cia406
from drivers.node import Node
from drivers.pdo import Inputs
from drivers.wiring import Place, Wiring
from rig.core.channels import Flag
from rig.core.clock import WallClock
from rig.core.errors import NotReady
from rig.core.sample import Mode, Torque
from sim.wire.frame import Frame
from sim.wire.inprocess import VirtualWire
from tests.drivers.foreign import Peer, Tpdo
from tests.drivers.virtual import wired

NODE = 40
ENCODER = {(0x1000, 0): b"\x96\x01\x00\x00", (0x6501, 0): struct.pack("<I", 4096), (0x6004, 0): bytes(4)}
TORQUE = {
    (0x1000, 0): b"\x94\x01\x00\x00",
    (0x6131, 1): b"\x00\x00\x56\x00",
    (0x6132, 1): b"\x03",
    (0x9130, 1): struct.pack("<i", -1250),
}
DRIVE = {
    (0x1000, 0): b"\x92\x01\x02\x00",
    (0x6040, 0): b"\0\0",
    (0x6041, 0): b"\x40\0",
    (0x6060, 0): b"\0",
    (0x6061, 0): b"\0",
    (0x6064, 0): bytes(4),
    (0x6071, 0): b"\0\0",
    (0x6077, 0): b"\0\0",
}
COMMANDS = Tpdo(0, 0x200 + NODE, 255, [(0x6040, 0, 16), (0x6060, 0, 8), (0x6071, 0, 16)])
STATUS = Tpdo(0, 0x180 + NODE, 1, [(0x6041, 0, 16), (0x6064, 0, 32)])
EFFORT = Tpdo(2, 0x380 + NODE, 1, [(0x2000, 1, 16), (0x6077, 0, 16)])
OTHER = {(0x2000, 1): b"\xaa\xbb"}


def place(role: str, **more: Any) -> Place:
    numbers = {"counts_per_turn": 4096, "torque_rated": 3.0, "torque_limit": 5.0, "speed_limit": 62.8, "range": 50.0}
    return Place(role, {"bus": "rig", "node": NODE, **more}, period=0.001, **numbers)


PLUGGED: list[Wiring] = []  # closed when the test ends


def wiring(wire: VirtualWire) -> Wiring:
    sections = {"rig": {"interface": "", "channel": "", "host_node": 127}}
    PLUGGED.append(Wiring(wire, sections, wire.connect))
    return PLUGGED[-1]


@pytest.fixture
def wire() -> Iterator[VirtualWire]:
    yield wired().wire
    while PLUGGED:
        PLUGGED.pop().bus(place("drive")).close()


def peer(wire: VirtualWire, objects: dict[tuple[int, int], bytes], **more: Any) -> Peer:
    return Peer(wire.assembly.bus, NODE, dict(objects), **more)


def tick(wire: VirtualWire, device: Any) -> Any:
    device.bus.sync()
    wire.wait_until(wire.now() + 0.001)
    return device.read()


@pytest.mark.parametrize("absent", [0x06020000, 0x06090011, 0x08000000, 0x06040041, 0x08000023, 0x06010001])
def test_an_encoder_whose_tpdo_3_is_fixed_is_decoded_by_what_is_in_it(wire: VirtualWire, absent: int):
    speed_first = Tpdo(2, 0x380 + NODE, 1, [(0x6030, 1, 16), (0x6004, 0, 32)])
    foreign = peer(wire, {**ENCODER, (0x6030, 1): b"\x07\0"}, tpdos=[speed_first], absent=absent)
    encoder = Cia406(wiring(wire), place("load_encoder"))
    identity = encoder.connect()
    assert identity.model == "vendor 0x0 product 0x0"  # neither name nor 1018h
    foreign.objects[0x6004, 0] = struct.pack("<I", 1024)
    assert tick(wire, encoder).counts == 1024
    assert any("keeps its own PDOs" in remark for remark in encoder.remarks)


@pytest.mark.parametrize("total", [{(0x6002, 0): bytes(4)}, {}])
def test_a_total_range_of_all_32_bits_that_6002h_cannot_hold_wraps_there(wire: VirtualWire, total: dict[Any, bytes]):
    scaled = {(0x6000, 0): b"\x04\0", (0x6001, 0): struct.pack("<I", 4096), **total}
    sent = [Tpdo(0, 0x180 + NODE, 1, [(0x6004, 0, 32)])]
    foreign = peer(wire, {**ENCODER, **scaled, (0x6004, 0): b"\xff\xff\xff\xff"}, tpdos=sent)
    encoder = Cia406(wiring(wire), place("load_encoder"))
    encoder.connect()
    before = encoder.read()
    foreign.objects[0x6004, 0] = struct.pack("<I", 1)
    after = tick(wire, encoder)
    assert after.counts - before.counts == 2
    assert after.flags == 0


def test_a_transducer_that_would_map_a_value_it_has_not_is_refused_by_name(wire: VirtualWire):
    silent = {where: value for where, value in TORQUE.items() if where[0] != 0x9130}
    peer(wire, silent, tpdos=[Tpdo(0, 0x180 + NODE, 1, [(0x6130, 1, 32)])])
    with pytest.raises(NotReady, match=r"torque neither as 9130h:1 nor as 6130h:1"):
        Cia404(wiring(wire), place("torque_sensor")).connect()


def test_a_node_without_a_heartbeat_is_told_by_the_age_of_its_pdos_alone(wire: VirtualWire):
    foreign = peer(wire, ENCODER, tpdos=[Tpdo(0, 0x180 + NODE, 1, [(0x6004, 0, 32)])], heartbeat=False)
    encoder = Cia406(wiring(wire), place("load_encoder"))
    encoder.connect()
    assert any("no heartbeat" in remark and "age of its PDOs" in remark for remark in encoder.remarks)
    reading = tick(wire, encoder)
    assert encoder.trouble == ""
    foreign.port.disconnect(False)
    assert tick(wire, encoder).t == reading.t  # stale: the guard trips on its age


def test_a_torque_sensor_that_knows_no_sync_is_stamped_by_arrival_and_that_is_said(wire: VirtualWire):
    peer(wire, TORQUE, tpdos=[Tpdo(1, 0x2A0, 254, [(0x9130, 1, 32)])])
    sensor = Cia404(wiring(wire), place("torque_sensor"))
    sensor.connect()
    assert any("does not follow SYNC" in remark for remark in sensor.remarks)
    first = sensor.read()
    wire.wait_until(wire.now() + 0.002)
    second = sensor.read()
    assert second.tau == pytest.approx(-1.25)
    assert second.t > first.t
    assert wire.now() - second.t < 0.0011


def test_a_number_that_stands_for_a_broken_cable_is_no_torque(wire: VirtualWire):
    """Told with a run that tripped on it: the shaft carried +2147483.6 N·m."""
    foreign = peer(wire, TORQUE, tpdos=[Tpdo(0, 0x180 + NODE, 1, [(0x9130, 1, 32)])])
    sensor = Cia404(wiring(wire), place("torque_sensor"))
    sensor.connect()
    assert sensor.read().tau == pytest.approx(-1.25)
    foreign.objects[0x9130, 1] = struct.pack("<i", 2**31 - 1)
    reading = tick(wire, sensor)
    assert math.isnan(reading.tau)
    assert reading.flags & Flag.SATURATED_TAU


def test_a_pdo_sent_after_every_fifth_sync_is_refused(wire: VirtualWire):
    peer(wire, ENCODER, tpdos=[Tpdo(0, 0x180 + NODE, 5, [(0x6004, 0, 32)])])
    with pytest.raises(NotReady, match=r"another count of SYNCs \(type 5\), expected after each"):
        Cia406(wiring(wire), place("load_encoder")).connect()


def test_a_fixed_pdo_that_lacks_what_is_needed_is_refused_by_name(wire: VirtualWire):
    peer(wire, {**ENCODER, (0x6030, 1): b"\0\0"}, tpdos=[Tpdo(0, 0x180 + NODE, 1, [(0x6030, 1, 16)])])
    with pytest.raises(NotReady, match=r"in the PDOs it sends of its own there is no 6004h"):
        Cia406(wiring(wire), place("load_encoder")).connect()


def test_a_bare_drive_with_fixed_pdos_is_walked_and_commanded_and_nothing_guards_it(wire: VirtualWire):
    foreign = peer(
        wire,
        {**DRIVE, **OTHER},
        tpdos=[STATUS, EFFORT],
        rpdos=[COMMANDS],
        writable={(0x6040, 0), (0x6060, 0), (0x6071, 0)},
    )
    drive = Cia402(wiring(wire), place("drive"))
    drive.connect()
    assert drive.watchdog.words == ""  # neither 1016h nor an RPDO timeout
    drive.enable()
    assert foreign.objects[0x6041, 0] == b"\x27\0"
    assert foreign.objects[0x6060, 0] == b"\x0a"
    foreign.objects[0x6077, 0] = struct.pack("<h", 100)
    reading = tick(wire, drive)
    assert reading.fault == ""
    assert reading.tau_m == pytest.approx(0.3)
    assert drive.write(Torque(0.6)) == pytest.approx(0.6)
    wire.wait_until(wire.now() + 0.002)
    assert foreign.objects[0x6071, 0] == struct.pack("<h", 200)
    assert drive.halt()
    assert foreign.objects[0x6041, 0] == b"\x40\0"


def test_a_drive_that_takes_no_positions_in_its_fixed_pdos_is_refused_for_that_mode(wire: VirtualWire):
    writable = {(0x6040, 0), (0x6060, 0), (0x6071, 0)}
    peer(wire, {**DRIVE, **OTHER, (0x607A, 0): bytes(4)}, tpdos=[STATUS, EFFORT], rpdos=[COMMANDS], writable=writable)
    drive = Cia402(wiring(wire), place("drive"))
    drive.connect()
    with pytest.raises(NotReady, match=r"in the PDOs it takes of its own there is no 607Ah"):
        drive.enable(Mode.POSITION)


@pytest.mark.parametrize(
    ("lacking", "told"),
    [(0x6077, r"tell its torque \(6077h\)"), (0x6071, r"target torque \(6071h\)"), (0x6064, r"its position \(6064h\)")],
)
def test_a_drive_that_would_map_an_object_it_has_not_is_refused_by_name(wire: VirtualWire, lacking: int, told: str):
    has = {where: value for where, value in {**DRIVE, **OTHER}.items() if where[0] != lacking}
    peer(wire, has, tpdos=[STATUS, EFFORT], rpdos=[COMMANDS], writable={(0x6040, 0), (0x6060, 0), (0x6071, 0)})
    with pytest.raises(NotReady, match=told):
        Cia402(wiring(wire), place("drive")).connect()


def test_a_fixed_rpdo_with_an_object_nobody_knows_is_not_guessed_at(wire: VirtualWire):
    strange = Tpdo(0, 0x200 + NODE, 255, [(0x6040, 0, 16), (0x2222, 0, 16), (0x6071, 0, 16)])
    writable = {(0x6040, 0), (0x6060, 0), (0x6071, 0)}
    foreign = {**DRIVE, **OTHER, (0x2222, 0): b"\0\0"}
    peer(wire, foreign, tpdos=[STATUS, EFFORT], rpdos=[strange], writable=writable)
    with pytest.raises(NotReady, match=r"takes of its own there is no 6040h and no 6071h"):
        Cia402(wiring(wire), place("drive")).connect()


def test_a_drive_without_torque_feedback_is_refused(wire: VirtualWire):
    peer(wire, DRIVE, tpdos=[STATUS], rpdos=[COMMANDS], writable={(0x6040, 0), (0x6060, 0), (0x6071, 0)})
    with pytest.raises(NotReady, match=r"sends of its own there is no 6077h"):
        Cia402(wiring(wire), place("drive")).connect()


def test_a_limit_that_cannot_be_set_is_remarked_on(wire: VirtualWire):
    objects = {**DRIVE, **OTHER, (0x6072, 0): b"\xe8\x03", (0x605A, 0): b"\x02\0"}
    writable = {(0x6040, 0), (0x6060, 0), (0x6071, 0)}
    peer(wire, objects, tpdos=[STATUS, EFFORT], rpdos=[COMMANDS], writable=writable, refuses=0x08000022)
    drive = Cia402(wiring(wire), place("drive"))
    drive.connect()
    told = " ".join(drive.remarks)
    assert "its torque is limited by this program alone" in told
    assert "it reacts in a way of its own" in told


@pytest.mark.slow
def test_canopen_s_own_node_is_read_and_mapped_as_it_stands():
    """The SDO server of another author, in real time on python-can's virtual bus."""
    dictionary = canopen.ObjectDictionary()
    for index, value in ((0x1000, 0x00010196), (0x6501, 4096), (0x6004, 77)):
        entry = canopen.objectdictionary.ODVariable(f"object {index:X}", index)
        entry.data_type, entry.access_type, entry.default = canopen.objectdictionary.UNSIGNED32, "rw", value
        dictionary.add_object(entry)
    network = canopen.Network()
    network.connect(interface="virtual", channel="foreign")
    local = canopen.LocalNode(NODE, dictionary)
    network.add_node(local)
    connect = lambda **_: can.Bus(interface="virtual", channel="foreign")  # noqa: E731
    host = HostBus("rig", "virtual", "foreign", WallClock(), {}, connect)
    try:
        node = Node(host, NODE, "encoder")
        node.open()
        node.sdo.patience(2.0)  # s: a busy machine
        assert node.identify(406).model == "vendor 0x0 product 0x0"
        assert node.sdo.read_uint(0x6501) == 4096
        assert node.sdo.text(0x1008) == ""
        with pytest.raises(NotReady, match=r"refused 1800h:1 .*in the PDOs it sends of its own there is no 6004h"):
            Inputs(node).arrange((POSITION,))
    finally:
        host.close()
        network.disconnect()


def held_up(wire: VirtualWire, encoder: Cia406, syncs: int, at_once: int) -> None:
    """A node that answers late: silent for `syncs`, then `at_once` answers to each further SYNC until all are given."""
    bus, port = encoder.bus, wire.assembly.bus.attach("late", lambda frame, t: None)
    owed = 0
    for k in range(4 * syncs):
        owed += 1
        bus.sync()
        for _ in range(min(owed, at_once) if k >= syncs else 0):
            port.send(Frame(0x180 + NODE, bytes(4)))
            owed -= 1
        wire.wait_until(wire.now() + 0.002)
        encoder.read()


def test_a_node_that_was_held_up_and_answers_several_syncs_at_once_is_no_second_one(wire: VirtualWire):
    foreign = peer(wire, ENCODER, tpdos=[Tpdo(0, 0x180 + NODE, 1, [(0x6004, 0, 32)])], heartbeat=False)
    encoder = Cia406(wiring(wire), place("load_encoder"))
    encoder.connect()
    foreign.port.disconnect(False)
    held_up(wire, encoder, syncs=30, at_once=2)
    assert encoder.trouble == ""
    foreign.port.reconnect()
    for _ in range(250):  # two answer each from now on
        encoder.bus.sync()
        wire.assembly.bus.attach("double", lambda frame, t: None).send(Frame(0x180 + NODE, bytes(4)))
        wire.wait_until(wire.now() + 0.002)
        encoder.read()
    assert "are there two nodes of this number?" in encoder.trouble
