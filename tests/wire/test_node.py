"""What every node does: boot, NMT, heartbeats both ways, guarding, emergencies, PDO parameters, storing. CiA 301."""

from __future__ import annotations

import pytest

from sim.wire.frame import EXTENDED
from tests.wire.host import BOOTED, Host, assembly, host

UNSUPPORTED, NOT_MAPPABLE, TOO_LONG, VALUE = "00 00 01 06", "41 00 04 06", "42 00 04 06", "30 00 09 06"


@pytest.fixture
def rig() -> Host:
    return host()


def map_status_and_torque(rig: Host, transmission: int) -> None:
    """TPDO 1 of the drive: 6041h and 6077h, in the order CiA 301 asks for."""
    for index, sub, kind, value in [
        (0x1800, 1, "I", 0xC0000181),
        (0x1800, 2, "B", transmission),
        (0x1A00, 0, "B", 0),
        (0x1A00, 1, "I", 0x60410010),
        (0x1A00, 2, "I", 0x60770010),
        (0x1A00, 0, "B", 2),
        (0x1800, 1, "I", 0x40000181),
    ]:
        assert rig.put(1, index, sub, kind, value) == ""


def test_every_node_says_once_that_it_has_booted() -> None:
    rig = Host(assembly())
    rig.wait(BOOTED)
    assert [(identifier, data) for _, identifier, data in rig.heard] == [(0x701, "00"), (0x702, "00"), (0x703, "00")]


def test_a_reset_boots_again_and_forgets(rig: Host) -> None:
    rig.put(1, 0x6060, 0, "b", 10)
    rig.send(0x000, "81 01")
    assert rig.hears(0x701, BOOTED) == ["00"]
    assert rig.get(1, 0x6060, 0, "b") == 0


def test_what_was_stored_survives_a_reset_until_it_is_restored(rig: Host) -> None:
    map_status_and_torque(rig, 1)
    assert rig.asks(1, "23 10 10 01 73 61 76 65") == "60 10 10 01 00 00 00 00"  # "save"
    rig.send(0x000, "81 01")
    rig.wait(BOOTED)
    assert rig.get(1, 0x1A00, 2, "I") == 0x60770010
    assert rig.asks(1, "23 11 10 01 6c 6f 61 64") == "60 11 10 01 00 00 00 00"  # "load"
    rig.send(0x000, "81 01")
    rig.wait(BOOTED)
    assert rig.get(1, 0x1A00, 0, "B") == 1
    assert rig.put(1, 0x1010, 1, "I", 1) != ""


def test_heartbeats_say_the_state(rig: Host) -> None:
    rig.put(2, 0x1017, 0, "H", 20)
    assert rig.hears(0x702, 0.1) == ["7f"] * 5
    rig.start(2)
    assert rig.hears(0x702, 0.1) == ["05"] * 5
    rig.send(0x000, "02 02")
    assert set(rig.hears(0x702, 0.1)) == {"04"}


def test_guarding_answers_with_a_toggle(rig: Host) -> None:
    answers = []
    for _ in range(3):
        rig.guards(0x701)
        answers += rig.hears(0x701, 0.01)
    assert answers == ["7f", "ff", "7f"]


def test_life_guarding_notices_that_nobody_asks_any_more(rig: Host) -> None:
    rig.put(2, 0x100C, 0, "H", 50)
    rig.put(2, 0x100D, 0, "B", 2)
    assert rig.hears(0x082, 1.0) == []
    rig.guards(0x702)
    assert rig.hears(0x082, 0.099) == []
    assert rig.hears(0x082, 1.0) == ["30 81 11 00 00 00 00 00"]


def test_a_heartbeat_consumer_starts_with_the_first_and_reports_the_missing_one(rig: Host) -> None:
    rig.put(2, 0x1016, 1, "I", 0x007F0064)  # node 127, 100 ms
    assert rig.hears(0x082, 1.0) == []
    for _ in range(3):
        rig.send(0x77F, "05")
        assert rig.hears(0x082, 0.09) == []
    assert rig.hears(0x082, 0.1) == ["30 81 11 00 00 00 00 00"]
    assert rig.get(2, 0x1001, 0, "B") == 0x11
    assert rig.get(2, 0x1003, 0, "B") == 1
    assert rig.get(2, 0x1003, 1, "I") == 0x8130


@pytest.mark.parametrize(("behaviour", "state"), [(0, "7f"), (1, "05"), (2, "04")])
def test_1029_says_what_a_lost_heartbeat_does_to_the_state(rig: Host, behaviour: int, state: str) -> None:
    rig.put(2, 0x1029, 1, "B", behaviour)
    rig.put(2, 0x1016, 1, "I", 0x007F0064)
    rig.put(2, 0x1017, 0, "H", 10)
    rig.start(2)
    rig.send(0x77F, "05")
    rig.wait(0.15)
    assert set(rig.hears(0x702, 0.05)) == {state}


def test_a_pdo_goes_on_sync_only_when_operational(rig: Host) -> None:
    map_status_and_torque(rig, 1)
    rig.send(0x080)
    assert rig.hears(0x181, 0.01) == []
    rig.start(1)
    rig.send(0x080)
    (data,) = rig.hears(0x181, 0.01)
    assert len(data) == len("50 02 00 00")
    assert data.startswith("50 02 ")  # switch on disabled, voltage, remote


def test_transmission_type_3_is_every_third_sync(rig: Host) -> None:
    map_status_and_torque(rig, 3)
    rig.start(1)
    counts = []
    for _ in range(7):
        rig.send(0x080)
        counts.append(len(rig.hears(0x181, 0.001)))
    assert counts == [0, 0, 1, 0, 0, 1, 0]


def test_an_event_timer_repeats_a_pdo_and_an_inhibit_time_holds_events_back(rig: Host) -> None:
    map_status_and_torque(rig, 254)
    rig.put(1, 0x1800, 5, "H", 10)
    rig.start(1)
    assert len(rig.hears(0x181, 0.1)) == 10
    rig.put(1, 0x1800, 5, "H", 0)
    rig.put(1, 0x1800, 3, "H", 500)  # 50 ms
    rig.wait(0.1)
    rig.heard.clear()
    for word in ("06", "07", "06", "07"):
        rig.send(0x601, f"2b 40 60 00 {word} 00 00 00")
        rig.wait(0.003)
    rig.wait(0.2)
    assert len([1 for _, identifier, _ in rig.heard if identifier == 0x181]) == 2


def test_pdos_answer_a_sync_in_the_order_of_their_identifiers(rig: Host) -> None:
    map_status_and_torque(rig, 1)
    rig.put(2, 0x1801, 1, "I", 0x40000282)
    rig.put(3, 0x1801, 1, "I", 0x40000283)
    rig.start()
    rig.wait(0.01)
    rig.heard.clear()
    rig.send(0x080)
    rig.wait(0.01)
    assert [identifier for _, identifier, _ in rig.heard] == [0x181, 0x282, 0x283]


@pytest.mark.parametrize(
    ("index", "sub", "kind", "value", "abort"),
    [
        (0x1A00, 1, "I", 0x60770010, UNSUPPORTED),  # while the PDO exists
        (0x1A00, 0, "B", 0, UNSUPPORTED),
        (0x1800, 1, "I", 0x40000182, VALUE),  # another identifier while it exists
        (0x1800, 1, "I", 0xE0000181, VALUE),  # 29 bits
        (0x1800, 2, "B", 245, VALUE),
    ],
)
def test_a_pdo_that_exists_is_not_changed(rig: Host, index: int, sub: int, kind: str, value: int, abort: str) -> None:
    assert rig.put(1, index, sub, kind, value) == abort


def test_a_mapping_is_refused_when_it_cannot_be_filled(rig: Host) -> None:
    rig.put(1, 0x1800, 1, "I", 0xC0000181)
    assert rig.put(1, 0x1A00, 1, "I", 0x60770010) == UNSUPPORTED  # entries before their number is 0
    rig.put(1, 0x1A00, 0, "B", 0)
    assert rig.put(1, 0x1A00, 1, "I", 0x20000010) == "00 00 02 06"
    assert rig.put(1, 0x1A00, 1, "I", 0x60760020) == NOT_MAPPABLE
    assert rig.put(1, 0x1A00, 1, "I", 0x60770020) == NOT_MAPPABLE  # 16 bits, not 32
    for sub, slot in enumerate((0x60640020, 0x606C0020, 0x60770010), 1):
        assert rig.put(1, 0x1A00, sub, "I", slot) == ""
    assert rig.put(1, 0x1A00, 0, "B", 3) == TOO_LONG  # ten bytes
    assert rig.put(1, 0x1A00, 0, "B", 2) == ""


def test_an_rpdo_acts_at_once_or_at_the_next_sync(rig: Host) -> None:
    rig.start(1)
    rig.send(0x201, "06 00")
    rig.wait(0.001)
    assert rig.get(1, 0x6041, 0, "H") == 0x0231
    rig.put(1, 0x1400, 2, "B", 1)
    rig.send(0x201, "07 00")
    rig.wait(0.001)
    assert rig.get(1, 0x6041, 0, "H") == 0x0231
    rig.send(0x080)
    rig.wait(0.001)
    assert rig.get(1, 0x6041, 0, "H") == 0x0233


def test_a_short_rpdo_is_not_used_and_told(rig: Host) -> None:
    rig.start(1)
    rig.send(0x201, "06")
    assert rig.hears(0x081, 0.01) == ["10 82 11 00 00 00 00 00"]
    assert rig.get(1, 0x6041, 0, "H") == 0x0250


def test_29_bit_frames_are_not_for_us(rig: Host) -> None:
    rig.send(0x601 | EXTENDED, "40 00 10 00 00 00 00 00")
    assert rig.hears(0x581, 0.01) == []
