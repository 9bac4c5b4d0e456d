"""Every fault shows on the wire: the verbs of the command channel against what a host then hears. Virtual time."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import pytest

from sim.wire.control import perform
from sim.wire.faults import fault_verbs
from sim.wire.frame import EXTENDED
from sim.wire.reactor import Reactor
from sim.wire.verbs import plant_verbs
from tests.wire.host import BOOTED, host

CST = 10


class Operator:
    """A host, and the verbs as the command channel knows them."""

    def __init__(self) -> None:
        self.host = host("twin.torque_noise=0.0", "twin.sensor_noise=0.0")
        reactor = Reactor(self.host.twin.agenda)
        faults = fault_verbs(self.host.twin, reactor, {}, {})
        self.verbs = {**plant_verbs(self.host.twin, reactor, faults["faults"]), **faults}
        self.host.put(2, 0x1801, 1, "I", 0x40000282)
        self.host.start()
        self.host.wait(0.01)

    def ask(self, do: str, **arguments: Any) -> Mapping[str, Any]:
        return perform(self.verbs, json.dumps({"do": do, **arguments}).encode())

    def do(self, do: str, **arguments: Any) -> Mapping[str, Any]:
        answer = self.ask(do, **arguments)
        assert answer["ok"], answer
        return answer

    def syncs(self, times: int = 4) -> list[str]:
        """What the load encoder answers to so many SYNCs, 1 ms apart."""
        self.host.heard.clear()
        for _ in range(times):
            self.host.send(0x080)
            self.host.wait(0.001)
        return [data for _, identifier, data in self.host.heard if identifier == 0x282]

    def position(self) -> int:
        return int(self.host.get(2, 0x6004, 0, "I"))


@pytest.fixture
def op() -> Operator:
    return Operator()


def test_lost_frames(op: Operator) -> None:
    op.do("drop", identifier="0x282", count=2)
    assert len(op.syncs(4)) == 2
    op.do("drop", identifier=0x282)
    assert op.syncs() == []
    op.do("heal")
    assert len(op.syncs()) == 4


def test_late_and_doubled_frames(op: Operator) -> None:
    op.do("delay", identifier=0x282, seconds=0.002)
    assert len(op.syncs(4)) == 2  # the last two are still on their way
    op.host.wait(0.01)
    op.do("heal")
    op.do("duplicate", identifier=0x282)
    assert len(op.syncs(4)) == 8
    op.do("heal")


def test_a_station_that_sent_its_frames_is_gone(op: Operator) -> None:
    before = len(op.host.twin.bus.ports)
    op.do("send", identifier=0x7E, data="01", every=0.001, count=5)
    assert op.host.hears(0x7E, 0.1) == ["01"] * 5
    assert len(op.host.twin.bus.ports) == before


def test_swapped_frames_arrive_in_pairs_the_second_first(op: Operator) -> None:
    op.do("reorder", identifier=0x7E)
    op.do("send", identifier=0x7E, data="01")
    op.do("send", identifier=0x7E, data="02")
    assert op.host.hears(0x7E, 0.01) == ["02", "01"]


def test_frames_of_the_wrong_length(op: Operator) -> None:
    op.do("resize", identifier=0x282, size=3)
    assert {len(bytes.fromhex(data)) for data in op.syncs()} == {3}
    assert not op.ask("resize", size=9)["ok"]


MADE: dict[str, tuple[str, dict[str, Any]]] = {
    "drop identifier=0x282": ("drop", {"identifier": 0x282}),
    "resize count=5": ("resize", {"size": 3, "count": 5}),
    "cut station=host 1": ("cut", {}),
    "sto active=true": ("sto", {"active": True}),
    "trip again=true": ("trip", {"code": 0x8611, "again": True}),
    "mode_stuck active=true": ("mode_stuck", {}),
    "slow_sdo device=encoder seconds=0.3": ("slow_sdo", {"device": "encoder", "seconds": 0.3}),
    "double: node 2 is there twice": ("double", {"device": "encoder"}),
    "send: 1 strange station(s) on the bus": ("babble", {}),
    "frozen device=drive": ("frozen", {"device": "drive"}),
    "overload device=torque": ("overload", {}),
    "broken_cable active=true": ("broken_cable", {}),
}


@pytest.mark.parametrize("said", MADE)
def test_status_lists_the_fault_that_stands_until_it_is_healed(op: Operator, said: str) -> None:
    assert op.do("status")["faults"] == []
    verb, arguments = MADE[said]
    op.do(verb, **arguments)
    assert op.do("status")["faults"] == op.do("faults")["faults"] == [said]
    op.do("heal")
    assert op.do("status")["faults"] == []


def test_a_fault_that_was_taken_back_or_has_used_up_its_count_no_longer_stands(op: Operator) -> None:
    op.do("sto")
    op.do("drop", identifier=0x282, count=2)
    op.do("cut", station="host 1")
    op.do("sto", active=False)
    op.do("join", station="host 1")
    assert op.do("status")["faults"] == ["drop identifier=0x282 count=2"]
    op.syncs(4)
    assert op.do("status")["faults"] == []


def test_a_cut_cable_and_the_old_frames_after_it(op: Operator) -> None:
    op.do("cut")
    assert op.syncs() == []
    op.do("join")
    assert len(op.syncs()) == 4
    op.do("cut", station="host 1", keeps=True)
    for _ in range(3):
        op.host.send(0x080)
    op.host.wait(0.5)
    op.do("join", station="host 1")
    assert len(op.host.hears(0x282, 0.01)) == 3  # three old SYNCs at once
    assert "no station" in op.ask("cut", station="moon")["error"]


def test_without_a_host_there_is_none_to_cut_off(op: Operator) -> None:
    op.host.port.leave()
    assert op.ask("cut")["error"].endswith("no host is on the bus, which could be cut off")


def test_a_cut_node_is_silent(op: Operator) -> None:
    op.do("cut", station="node 2")
    assert op.syncs() == []
    assert op.host.asks(2, "40 00 10 00 00 00 00 00") == ""
    assert op.host.asks(1, "40 00 10 00 00 00 00 00") != ""


def test_bus_off_is_an_error_frame_and_silence(op: Operator) -> None:
    op.do("bus_off")
    assert op.host.heard[-1][1:] == (0x20000040, "00 00 00 00 00 00 00 00")
    assert op.syncs() == []
    op.do("join")
    assert len(op.syncs()) == 4


def test_two_nodes_of_one_number_answer_twice_and_boot_in_mid_run(op: Operator) -> None:
    op.do("double", device="encoder")
    assert op.host.hears(0x702, BOOTED) == ["00"]
    op.host.send(0x602, "40 00 10 00 00 00 00 00")
    assert op.host.hears(0x582, 0.01) == ["43 00 10 00 96 01 02 00"] * 2
    op.do("heal")
    op.host.send(0x602, "40 00 10 00 00 00 00 00")
    assert op.host.hears(0x582, 0.01) == ["43 00 10 00 96 01 02 00"]


def test_a_babbling_node_takes_the_bus(op: Operator) -> None:
    op.do("babble", identifier=0x001, seconds=1.0)
    assert len(op.syncs(20)) <= 2
    op.host.wait(1.0)
    assert op.host.twin.bus.load > 0.9
    op.do("heal")
    op.host.wait(1.0)
    assert len(op.syncs()) == 4


def test_a_babbling_node_of_low_rank_only_makes_others_wait(op: Operator) -> None:
    op.do("babble", identifier=0x7FF, seconds=1.0)
    assert len(op.syncs(20)) == 20


def test_a_second_master_gets_answers_we_did_not_ask_for(op: Operator) -> None:
    op.do("second_master", node=1, every=0.01, count=10)
    assert op.host.hears(0x581, 0.2) == ["43 00 10 00 92 01 02 00"] * 10


def test_frames_with_29_bits_and_what_is_no_frame(op: Operator) -> None:
    op.do("send", identifier=0x181, data="0102", extended=True)
    assert op.host.hears(0x181 | EXTENDED, 0.01) == ["01 02"]
    for wrong in ({"data": "xyz"}, {"data": "00" * 9}, {"count": 5}, {"identifier": "much"}):
        assert not op.ask("send", **{"identifier": 1, **wrong})["ok"]


def test_a_reboot_is_heard_and_loses_the_mapping(op: Operator) -> None:
    op.do("reboot", device="encoder")
    assert op.host.hears(0x702, BOOTED) == ["00"]
    assert op.host.get(2, 0x1017, 0, "H") == 0
    op.do("reboot", device="drive")
    assert op.host.hears(0x701, BOOTED) == ["00"]


def test_an_emergency_and_a_trip(op: Operator) -> None:
    op.do("emergency", device="torque", code="0x5030")
    assert op.host.hears(0x083, 0.01) == ["30 50 81 00 00 00 00 00"]
    op.host.enable(CST)
    op.do("trip", code=0x3210, again=True)
    assert op.host.hears(0x081, 0.01) == ["10 32 21 00 00 00 00 00"]
    op.host.put(1, 0x6040, 0, "H", 0x80)
    assert int(op.host.get(1, 0x6041, 0, "H")) & 0x4F == 0x08
    op.do("heal")
    op.host.put(1, 0x6040, 0, "H", 0x00)
    op.host.put(1, 0x6040, 0, "H", 0x80)
    assert int(op.host.get(1, 0x6041, 0, "H")) & 0x4F == 0x40


def test_slow_answers_are_healed(op: Operator) -> None:
    asked = 0.45  # s, longer than a host waits
    op.do("slow_sdo", device="drive", seconds=asked)
    assert op.host.twin.drive.sdo_turnround == asked
    op.do("heal")
    assert op.host.twin.drive.sdo_turnround == op.host.twin.encoder.sdo_turnround < 0.01


def test_sto_and_a_stuck_mode(op: Operator) -> None:
    op.host.enable(CST)
    op.do("sto")
    assert int(op.host.get(1, 0x6041, 0, "H")) & 0x5F == 0x40
    op.do("sto", active=False)
    op.do("mode_stuck")
    op.host.put(1, 0x6060, 0, "b", 9)
    op.host.wait(0.1)
    assert op.host.get(1, 0x6061, 0, "b") == CST


def test_another_tool_changes_what_numbers_mean(op: Operator) -> None:
    op.do("put", device="drive", index="0x6076", value=3000000)
    assert op.host.get(1, 0x6076, 0, "I") == 3000000  # µN·m where mN·m should be
    op.do("put", device="torque", index="0x6131", sub=1, value=0x002D0000)
    assert op.host.get(3, 0x6131, 1, "I") == 0x002D0000  # degrees Celsius
    op.do("put", device="drive", index="0x1000", value=0x192)
    assert op.host.get(1, 0x1000, 0, "I") == 0x192  # read only for us
    for wrong in ({"index": "0x2000"}, {"index": "0x6060", "value": 77}, {"index": "0x6076", "value": -1}):
        assert not op.ask("put", **{"device": "drive", "value": 1, **wrong})["ok"]


def test_another_tool_remaps_a_pdo(op: Operator) -> None:
    for index, sub, value in [(0x1801, 1, 0xC0000282), (0x1A01, 0, 0), (0x1A01, 1, 0x60300110), (0x1A01, 0, 1)]:
        op.do("put", device="encoder", index=index, sub=sub, value=value)
    op.do("put", device="encoder", index=0x1801, sub=1, value=0x40000282)
    assert {len(bytes.fromhex(data)) for data in op.syncs()} == {2}


def test_the_position_register_close_to_its_wrap(op: Operator) -> None:
    op.do("position", offset=2**31 - 1)
    assert op.host.get(1, 0x6064, 0, "i") == 2**31 - 1


def test_slow_answers(op: Operator) -> None:
    op.do("slow_sdo", device="drive", seconds=0.45)
    assert op.host.asks(1, "40 00 10 00 00 00 00 00") == ""
    assert op.host.hears(0x581, 0.5) == ["43 00 10 00 92 01 02 00"]


def test_sensors_freeze_jump_scale_overload_and_heal(op: Operator) -> None:
    start = op.position()
    op.do("jump", device="encoder", by=0.1)
    assert op.position() == pytest.approx(start + 0.1 / 6.283185 * 900_000, abs=2)
    op.do("heal")
    assert op.position() == start
    op.do("frozen", device="drive")
    op.host.wait(0.001)
    op.host.enable(CST)
    op.host.put(1, 0x6071, 0, "h", 400)
    op.host.wait(0.3)
    assert op.host.get(1, 0x6064, 0, "i") == 0
    op.do("heal")
    moved = op.host.get(1, 0x6064, 0, "i")
    assert moved > 1000
    op.do("scale", device="drive", factor=-1)
    op.host.wait(0.001)
    assert op.host.get(1, 0x6064, 0, "i") < -1000
    op.do("overload", sign=-1)
    assert op.host.get(3, 0x6150, 1, "B") == 0b101
    op.do("heal")
    op.do("broken_cable")
    assert op.host.get(3, 0x6150, 1, "B") == 1
    assert "no device" in op.ask("frozen", device="moon")["error"]


def test_a_weight_a_clamp_and_the_truth(op: Operator) -> None:
    before = op.do("truth")["theta_l"]
    op.do("load", tau_ext=-10.0)
    op.host.wait(1.0)
    truth = op.do("truth")
    assert truth["simulated"] is True
    assert truth["theta_l"] < before - 0.001  # 10 N·m at 7160 N·m/rad is 1.4 mrad, friction holds 1 N·m
    op.do("load", tau_ext=0.0)
    op.do("reassemble", depth_mm=0.1)
    op.host.wait(0.1)
    op.do("lock")
    op.host.enable(CST)
    op.host.put(1, 0x6071, 0, "h", 250)
    op.host.wait(0.5)
    assert op.do("truth")["omega_l"] == 0.0
    op.do("unlock")
    op.host.wait(0.1)
    assert op.do("truth")["omega_l"] != 0.0
    assert "locked at rest only" in op.ask("lock")["error"]
    assert op.do("status")["drive"] == "OPERATION_ENABLED"


@pytest.mark.parametrize(
    "line", [b"", b"[]", b"{}", b'{"do": "fly"}', b'{"do": "load"}', b'{"do": "load", "tau_ext": "x"}']
)
def test_what_cannot_be_meant_is_answered_with_a_sentence(op: Operator, line: bytes) -> None:
    answer = perform(op.verbs, line)
    assert answer["ok"] is False
    assert answer["error"]
