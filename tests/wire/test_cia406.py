"""The load encoder: 900 000 units a turn, 4096 turns told apart, absolute."""

from __future__ import annotations

import math

import pytest

from tests.wire.host import BOOTED, Host, host

TURN = 900_000
TOO_HIGH, TOO_LOW = "31 00 09 06", "32 00 09 06"


@pytest.fixture
def rig() -> Host:
    return host()


def turn_load(rig: Host, seconds: float) -> float:
    """Push the load for a while; how far it went [rad]."""
    before = rig.twin.world.truth().theta_l
    rig.enable(10)
    rig.put(1, 0x6071, 0, "h", 300)
    rig.wait(seconds)
    rig.put(1, 0x6071, 0, "h", 0)
    rig.wait(0.001)
    return rig.twin.world.truth().theta_l - before


def test_it_says_what_it_is_and_how_fine(rig: Host) -> None:
    assert rig.asks(2, "40 00 10 00 00 00 00 00") == "43 00 10 00 96 01 02 00"
    assert rig.get(2, 0x6501, 0, "I") == TURN
    assert rig.get(2, 0x6502, 0, "H") == 4096
    assert rig.get(2, 0x6001, 0, "I") == TURN
    assert rig.get(2, 0x6002, 0, "I") == TURN * 4096


def test_position_follows_the_load(rig: Host) -> None:
    rig.put(2, 0x6003, 0, "I", 1_000_000)
    assert rig.get(2, 0x6004, 0, "I") == 1_000_000
    way = turn_load(rig, 0.3)
    assert way > 0.05
    moved = rig.get(2, 0x6004, 0, "I") - 1_000_000
    truth = rig.twin.world.truth()
    slip = abs(truth.omega_l) * 0.004 * TURN / (2 * math.pi)  # the answer was on its way for that long
    assert moved == pytest.approx(way / (2 * math.pi) * TURN, abs=slip + 2)


def test_position_wraps_at_the_total_range_not_at_32_bits(rig: Host) -> None:
    rig.put(2, 0x6002, 0, "I", 2 * TURN)
    rig.put(2, 0x6003, 0, "I", 2 * TURN - 1000)
    turn_load(rig, 0.3)
    assert rig.get(2, 0x6004, 0, "I") < TURN


def test_a_preset_outside_the_range_and_scales_finer_than_the_disc_are_refused(rig: Host) -> None:
    rig.put(2, 0x6002, 0, "I", TURN)
    assert rig.put(2, 0x6003, 0, "I", TURN) == TOO_HIGH
    assert rig.put(2, 0x6001, 0, "I", TURN + 1) == TOO_HIGH
    assert rig.put(2, 0x6001, 0, "I", 0) == TOO_LOW


def test_scaling_changes_the_unit_and_switching_it_off_gives_the_disc(rig: Host) -> None:
    rig.put(2, 0x6003, 0, "I", 90_000)  # a tenth of a turn
    rig.put(2, 0x6001, 0, "I", 3600)
    assert rig.get(2, 0x6004, 0, "I") == 360
    rig.put(2, 0x6000, 0, "H", 0)
    assert rig.get(2, 0x6004, 0, "I") == 90_000


def test_the_code_sequence_turns_the_sense_around(rig: Host) -> None:
    rig.put(2, 0x6000, 0, "H", 0b101)
    rig.put(2, 0x6003, 0, "I", 1_000_000)
    turn_load(rig, 0.3)
    assert rig.get(2, 0x6004, 0, "I") < 1_000_000


def test_position_survives_a_reboot(rig: Host) -> None:
    rig.put(2, 0x6003, 0, "I", 123_456)
    rig.send(0x000, "81 02")
    rig.wait(BOOTED)
    assert rig.get(2, 0x6004, 0, "I") == 123_456


def test_speed_is_units_per_ten_milliseconds(rig: Host) -> None:
    rig.enable(9)
    rig.put(1, 0x60FF, 0, "i", 50_000)  # 5 motor turns/s: 0.1 load turns/s
    rig.wait(1.0)
    assert rig.get(2, 0x6030, 1, "h") == pytest.approx(0.1 * TURN * 0.01, rel=0.05)


def test_the_cyclic_timer_sends_the_first_tpdo_and_sync_the_second(rig: Host) -> None:
    rig.start(2)
    rig.wait(0.01)
    assert rig.put(2, 0x6200, 0, "H", 10) == ""
    assert len(rig.hears(0x182, 0.1)) == 10
    rig.put(2, 0x6200, 0, "H", 0)
    rig.wait(0.02)
    assert rig.hears(0x182, 0.1) == []
    rig.send(0x080)
    (data,) = rig.hears(0x282, 0.01)
    assert int.from_bytes(bytes.fromhex(data), "little") == rig.get(2, 0x6004, 0, "I")
