"""The torque transducer: ±50 N·m, integers in thousandths of a newton metre."""

from __future__ import annotations

import math

import pytest

from sim.faults import Overload
from tests.wire.host import BOOTED, Host, host

QUIET = ("twin.sensor_noise=0.0", "twin.sensor_zero=0.0")


@pytest.fixture
def rig() -> Host:
    """Output locked, 0.7 N·m at the motor: a steady torque at the sensor."""
    made = host(*QUIET)
    made.twin.world.lock_output()
    made.enable(10)
    made.put(1, 0x6071, 0, "h", 233)
    made.wait(2.0)
    return made


def truth(rig: Host) -> float:
    return rig.twin.world.truth().tau_l


def test_it_says_what_it_is_and_in_which_unit(rig: Host) -> None:
    assert rig.asks(3, "40 00 10 00 00 00 00 00") == "43 00 10 00 94 01 02 00"
    assert rig.asks(3, "40 31 61 01 00 00 00 00") == "43 31 61 01 00 00 56 00"  # newton metre, no prefix
    assert rig.get(3, 0x6132, 1, "B") == 3


def test_all_three_types_of_the_process_value_agree_and_the_short_one_ends_at_32_767(rig: Host) -> None:
    assert abs(truth(rig)) > 10.0
    assert rig.get(3, 0x6130, 1, "f") == pytest.approx(truth(rig), abs=0.002)
    assert rig.get(3, 0x9130, 1, "i") == pytest.approx(1000 * truth(rig), abs=2)
    assert rig.get(3, 0x7130, 1, "h") == 32767  # 16 bits do not reach to 38 N·m in thousandths
    rig.put(3, 0x6132, 1, "B", 2)
    assert rig.get(3, 0x7130, 1, "h") == pytest.approx(100 * truth(rig), abs=1)


def test_digits_and_prefix_say_what_a_number_means(rig: Host) -> None:
    rig.put(3, 0x6132, 1, "B", 1)
    assert rig.get(3, 0x9130, 1, "i") == pytest.approx(10 * truth(rig), abs=1)
    rig.put(3, 0x6131, 1, "I", 0xFD560000)  # millinewton metres
    assert rig.get(3, 0x9130, 1, "i") == pytest.approx(10_000 * truth(rig), abs=20)
    assert rig.get(3, 0x6130, 1, "f") == pytest.approx(1000 * truth(rig), abs=2)


def test_tare_changes_the_net_value_zero_changes_both_and_power_loses_both(rig: Host) -> None:
    assert rig.asks(3, "23 39 61 01 74 61 72 61") == "60 39 61 01 00 00 00 00"  # "tara"
    assert rig.get(3, 0x6140, 1, "f") == pytest.approx(0.0, abs=0.003)
    assert abs(rig.get(3, 0x6130, 1, "f")) > 10.0
    assert rig.asks(3, "23 25 61 01 7a 65 72 6f") == "60 25 61 01 00 00 00 00"  # "zero"
    assert rig.get(3, 0x6130, 1, "f") == pytest.approx(0.0, abs=0.003)
    assert rig.put(3, 0x6139, 1, "I", 1) != ""
    rig.send(0x000, "81 03")
    rig.wait(BOOTED)
    assert abs(rig.get(3, 0x6130, 1, "f")) > 10.0


def test_overload_and_a_broken_cable_are_said_in_the_status(rig: Host) -> None:
    assert rig.get(3, 0x6150, 1, "B") == 0
    rig.twin.torque.sensor.fault = Overload(-1)
    assert rig.get(3, 0x6150, 1, "B") == 0b101
    assert rig.get(3, 0x9130, 1, "i") == pytest.approx(-50_000, abs=2)
    rig.twin.torque.sensor.fault = None
    rig.twin.torque.broken = True
    assert rig.get(3, 0x6150, 1, "B") == 1
    assert math.isnan(rig.get(3, 0x6130, 1, "f"))
    assert rig.get(3, 0x9130, 1, "i") == 2**31 - 1


def test_value_and_status_go_on_sync(rig: Host) -> None:
    rig.start(3)
    rig.wait(0.01)
    rig.send(0x080)
    (data,) = rig.hears(0x283, 0.01)
    raw = bytes.fromhex(data)
    assert len(raw) == 5
    assert raw[4] == 0
    assert int.from_bytes(raw[:4], "little", signed=True) == pytest.approx(1000 * truth(rig), abs=2)
