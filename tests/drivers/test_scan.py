"""Who is on the bus, and a first bench file from it."""

from __future__ import annotations

import pytest

from drivers.bus import Bus
from drivers.scan import Found, listen, scan
from rig.config.bench_file import read_bench
from rig.core.devices import Identity
from rig.core.errors import UsageError
from rig.first_bench import adapter_options, first_bench
from sim.wire.bus import Bus as WireBus
from sim.wire.frame import Frame
from sim.wire.odrive import Axis, Settings
from tests.drivers.virtual import RATING, wired


@pytest.fixture(scope="module")
def nodes() -> list[Found]:
    wire = wired().wire
    bus = Bus("scan", "", "", wire, {}, wire.connect)
    bus.open()
    found = scan(bus)
    bus.close()
    return found


@pytest.mark.slow
def test_every_node_is_found_with_profile_identity_and_plate(nodes: list[Found]):
    assert [(n.number, n.profile) for n in nodes] == [(1, 402), (2, 406), (3, 404)]
    assert nodes[0].identity.model == "hdrig twin servo drive"
    assert nodes[0].plate == {"torque_rated": 3.0, "counts_per_turn": 10_000.0}
    assert nodes[1].plate == {"counts_per_turn": 900_000.0}


def test_a_rated_torque_that_no_motor_has_of_its_current_is_in_another_unit():
    w = wired()
    w.twin.drive.rated_torque.value = 3_000_000  # µN·m, beside 6 A
    bus = Bus("scan", "", "", w.wire, {}, w.wire.connect)
    bus.open()
    found = scan(bus)
    bus.close()
    assert found[0].plate["torque_rated"] == pytest.approx(3.0)
    bench = read_bench(first_bench("socketcan", "can0", 1_000_000, found), "first.toml")
    assert bench.devices.drive.rated_step == 1e-6
    assert bench.motor.torque_rated == pytest.approx(3.0)


def test_the_first_bench_file_can_be_read_and_holds_what_was_found(nodes: list[Found]):
    bench = read_bench(first_bench("socketcan", "can0", 500_000, nodes), "first.toml")
    assert bench.bus["rig"].interface == "socketcan"
    assert bench.bus["rig"].bitrate == 500_000
    assert bench.devices.drive.type == "can.cia402"
    assert bench.devices.torque_sensor is not None
    assert bench.motor.counts_per_turn == 10_000


def test_the_first_bench_file_of_real_devices_has_nothing_of_the_twin(nodes: list[Found]):
    real = [node._replace(identity=Identity("SDC-400", "17", "2.1")) for node in nodes]
    bench = read_bench(first_bench("socketcan", "can0", 1_000_000, real), "first.toml")
    assert bench.hand is None
    assert bench.gear.serial == "UNNAMED"
    assert read_bench(first_bench("socketcan", "can0", 1_000_000, nodes), "first.toml").hand is not None


def test_a_serial_adapter_gets_a_rate_it_can_carry_and_the_pause_it_needs(nodes: list[Found]):
    bench = read_bench(first_bench("slcan", "/dev/ttyACM0", 1_000_000, nodes), "first.toml")
    assert bench.loop.rate == 250.0
    assert bench.bus["rig"].options == {}


def test_devices_that_did_not_answer_are_left_out(nodes: list[Found]):
    bench = read_bench(first_bench("pcan", "PCAN_USBBUS1", 1_000_000, nodes[:1]), "first.toml")
    assert bench.devices.load_encoder is None
    assert bench.devices.torque_sensor is None


def test_where_an_odrive_is_heard_it_is_told_and_no_canopen_question_is_asked():
    wire = wired().wire
    own = WireBus(wire.assembly.agenda, 1e6)
    Axis(own, 5, wire.assembly.world, RATING, Settings(heartbeat=0.1))
    heard: list[int] = []
    own.attach("witness", lambda frame, t: heard.append(frame.identifier))
    bus = Bus("scan", "", "", wire, {}, lambda **_: wire.door(own)())
    bus.open()
    found = scan(bus)
    bus.close()
    assert [(axis.number, axis.speaks, axis.identity.model) for axis in found] == [(5, "CANSimple", "ODrive twin")]
    assert {(identifier & 0x7FF) >> 5 for identifier in heard} == {5}
    bench = read_bench(first_bench("socketcan", "can1", 1_000_000, found), "first.toml")
    assert (bench.devices.drive.type, bench.devices.drive.node) == ("can.odrive", 5)


def test_a_heartbeat_of_canopen_says_that_what_looks_like_an_axis_is_none():
    w = wired()
    stranger = w.twin.bus.attach("a TPDO of node 1 and a heartbeat", lambda frame, t: None)

    def send() -> None:  # 0x181 could be the heartbeat of an idle axis 12
        stranger.send(Frame(0x181, bytes((0, 0, 0, 0, 1, 0, 0, 0))))
        stranger.send(Frame(0x705, b"\x05"))
        w.twin.agenda.after(0.05, send)

    send()
    bus = Bus("scan", "", "", w.wire, {}, w.wire.connect)
    bus.open()
    assert listen(bus) == []
    bus.close()


def test_options_an_adapter_needs_are_in_the_first_bench_file(nodes: list[Found]):
    options = adapter_options(["host=10.0.0.5", "port=29536", "tcp_tune=true"])
    bench = read_bench(first_bench("socketcand", "can0", 1_000_000, nodes, options), "first.toml")
    assert bench.bus["rig"].options == {"host": "10.0.0.5", "port": 29536, "tcp_tune": True}
    with pytest.raises(UsageError, match="expected name=value"):
        adapter_options(["29536"])
