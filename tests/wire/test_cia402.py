"""The servo drive: state machine, modes, units, what stops it. Values of CiA 402 written out."""

from __future__ import annotations

import math

import pytest

from sim.wire.states402 import DriveState
from tests.wire.host import BOOTED, Host, host

CSP, CSV, CST = 8, 9, 10
DISABLED, READY, ON, ENABLED, QUICK_STOP, FAULT = 0x0250, 0x0231, 0x0233, 0x0237, 0x0217, 0x0218
FOLLOWS = 0x1000  # bit 12


@pytest.fixture
def rig() -> Host:
    made = host()
    made.start(1)
    return made


def status(rig: Host) -> int:
    return int(rig.get(1, 0x6041, 0, "H"))


def control(rig: Host, word: int) -> int:
    """The statusword after a controlword."""
    assert rig.put(1, 0x6040, 0, "H", word) == ""
    rig.wait(0.002)
    return status(rig)


def omega(rig: Host) -> float:
    return rig.twin.world.truth().omega_m


def test_the_way_up_and_down(rig: Host) -> None:
    assert status(rig) == DISABLED
    assert control(rig, 0x0F) == DISABLED  # no short cut
    assert control(rig, 0x06) == READY
    assert control(rig, 0x07) == ON
    assert control(rig, 0x0F) == ENABLED
    assert control(rig, 0x07) == ON
    assert control(rig, 0x0F) == ENABLED
    assert control(rig, 0x06) == READY
    assert control(rig, 0x0F) == ENABLED  # transitions 3 and 4 at once
    assert control(rig, 0x00) == DISABLED
    control(rig, 0x06)
    assert control(rig, 0x02) == DISABLED  # quick stop before operation: disabled


def test_a_quick_stop_brakes_and_ends_disabled_or_stays_as_605a_says(rig: Host) -> None:
    for option, ends in ((2, DISABLED), (6, QUICK_STOP)):
        rig.put(1, 0x605A, 0, "h", option)
        rig.enable(CST)
        rig.put(1, 0x6071, 0, "h", 300)
        rig.wait(0.3)
        assert omega(rig) > 30.0
        rig.put(1, 0x6040, 0, "H", 0x0002)
        assert rig.twin.drive.drive_state is DriveState.QUICK_STOP_ACTIVE
        rig.wait(2.0)
        assert abs(omega(rig)) < 0.1
        assert status(rig) & ~0x0800 == ends  # the torque limit may just be reached
        rig.put(1, 0x6071, 0, "h", 0)
        assert control(rig, 0x00) == DISABLED


def test_quick_stop_leads_back_to_operation_only_where_it_stays(rig: Host) -> None:
    rig.put(1, 0x605A, 0, "h", 6)
    rig.enable(CST)
    control(rig, 0x02)
    assert control(rig, 0x0F) & 0x6F == 0x27


def test_a_fault_takes_the_torque_off_says_its_code_and_is_reset_by_an_edge_only(rig: Host) -> None:
    rig.enable(CST)
    rig.put(1, 0x6071, 0, "h", 300)
    rig.wait(0.1)
    rig.twin.drive.fault(0x2310)
    assert rig.hears(0x081, 0.01) == ["10 23 21 00 00 00 00 00"]
    assert status(rig) == FAULT
    assert rig.get(1, 0x603F, 0, "H") == 0x2310
    rig.wait(0.05)
    assert abs(rig.twin.world.truth().tau_m) < 1e-9
    assert control(rig, 0x0F) == FAULT
    assert control(rig, 0x80) == DISABLED  # never further by itself
    assert rig.get(1, 0x603F, 0, "H") == 0
    rig.twin.drive.fault(0x2310)
    rig.wait(0.01)
    assert control(rig, 0x80) == FAULT  # bit 7 was still set: no edge
    control(rig, 0x00)
    assert control(rig, 0x80) == DISABLED


def test_a_fault_whose_cause_is_still_there_comes_back(rig: Host) -> None:
    rig.twin.drive.incurable = True
    rig.twin.drive.fault(0x3210)
    rig.wait(0.01)
    assert control(rig, 0x80) == FAULT
    rig.twin.drive.incurable = False
    control(rig, 0x00)
    assert control(rig, 0x80) == DISABLED


def test_torque_is_per_mille_of_rated_torque(rig: Host) -> None:
    rig.twin.world.lock_output()
    rig.enable(CST)
    rig.put(1, 0x6071, 0, "h", 500)
    rig.wait(0.1)
    assert rig.get(1, 0x6076, 0, "I") == 3000  # mN·m
    assert rig.twin.world.truth().tau_m == pytest.approx(1.5)
    assert rig.get(1, 0x6077, 0, "h") == pytest.approx(500, abs=10)  # 4 mN·m of noise, 1 σ


def test_torque_before_operation_is_enabled_does_nothing(rig: Host) -> None:
    rig.put(1, 0x6060, 0, "b", CST)
    rig.put(1, 0x6071, 0, "h", 500)
    control(rig, 0x06)
    control(rig, 0x07)
    rig.wait(0.1)
    assert rig.twin.world.truth().tau_m == 0.0


def test_the_torque_limit_6072_is_kept_and_said(rig: Host) -> None:
    rig.put(1, 0x6072, 0, "H", 200)
    rig.enable(CST)
    rig.twin.world.lock_output()
    rig.put(1, 0x6071, 0, "h", 500)
    rig.wait(0.05)
    assert rig.twin.world.truth().tau_m == pytest.approx(0.6)
    assert status(rig) == ENABLED | FOLLOWS | 0x0800


def test_velocity_is_increments_per_second_and_position_follows_it(rig: Host) -> None:
    rig.enable(CSV)
    rig.put(1, 0x60FF, 0, "i", 50_000)  # 5 turns/s
    rig.wait(1.0)
    assert omega(rig) == pytest.approx(5 * 2 * math.pi, rel=0.02)
    assert rig.get(1, 0x606C, 0, "i") == pytest.approx(50_000, rel=0.05)
    before, t = rig.get(1, 0x6064, 0, "i"), rig.twin.agenda.now
    rig.wait(0.5)
    after = rig.get(1, 0x6064, 0, "i")
    assert (after - before) / (rig.twin.agenda.now - t) == pytest.approx(50_000, rel=0.02)


def test_position_holds_where_it_was_enabled_and_follows_targets(rig: Host) -> None:
    rig.put(1, 0x607A, 0, "i", 123_456)  # left over from somebody else: not gone to
    rig.enable(CSP)
    start = rig.get(1, 0x6064, 0, "i")
    rig.wait(0.2)
    assert rig.get(1, 0x6064, 0, "i") == pytest.approx(start, abs=20)
    for step in range(1, 501):
        rig.send(0x601, (b"\x23\x7a\x60\x00" + int(start + 20 * step).to_bytes(4, "little", signed=True)).hex())
        rig.wait(0.002)
    rig.wait(0.5)
    assert rig.get(1, 0x6064, 0, "i") == pytest.approx(start + 10_000, abs=100)


def test_a_target_too_far_away_is_a_following_error(rig: Host) -> None:
    rig.put(1, 0x6072, 0, "H", 100)  # too weak to move
    rig.enable(CSP)
    rig.put(1, 0x607A, 0, "i", 5_000)  # half a turn, the window is a quarter
    rig.wait(0.05)
    assert status(rig) & 0x2000
    assert "11 86 21 00 00 00 00 00" in rig.hears(0x081, 0.2)
    assert status(rig) == FAULT


def test_a_mode_is_confirmed_a_little_later_and_unless_it_is_stuck(rig: Host) -> None:
    rig.put(1, 0x6060, 0, "b", CST)
    rig.wait(0.005)
    assert rig.get(1, 0x6061, 0, "b") == CST
    rig.twin.drive.mode_stuck = True
    rig.put(1, 0x6060, 0, "b", CSV)
    rig.wait(0.1)
    assert rig.get(1, 0x6061, 0, "b") == CST
    assert rig.get(1, 0x6502, 0, "I") == 0x380


def test_safe_torque_off_is_a_loss_of_enable_that_does_not_come_back(rig: Host) -> None:
    rig.enable(CST)
    rig.put(1, 0x6071, 0, "h", 300)
    rig.twin.drive.sto(True, fault=False)
    assert status(rig) == 0x0240  # disabled, no voltage
    assert rig.get(1, 0x60FD, 0, "I") == 0x08
    assert control(rig, 0x06) == 0x0240
    rig.twin.drive.sto(False, fault=False)
    assert status(rig) == DISABLED
    rig.wait(0.05)
    assert abs(rig.twin.world.truth().tau_m) < 1e-9


def test_safe_torque_off_as_a_fault_cannot_be_reset_while_it_lasts(rig: Host) -> None:
    rig.enable(CST)
    rig.twin.drive.sto(True, fault=True)
    rig.wait(0.01)
    assert control(rig, 0x80) & 0x4F == 0x08
    rig.twin.drive.sto(False, fault=True)
    control(rig, 0x00)
    assert control(rig, 0x80) == DISABLED


def test_a_lost_heartbeat_stops_the_drive_with_8130(rig: Host) -> None:
    rig.put(1, 0x1016, 1, "I", 0x007F0064)
    rig.enable(CST)
    rig.put(1, 0x6071, 0, "h", 300)
    for _ in range(5):
        rig.send(0x77F, "05")
        rig.wait(0.08)
    assert omega(rig) > 10.0
    assert rig.hears(0x081, 0.2) == ["30 81 11 00 00 00 00 00"]
    assert status(rig) == FAULT
    assert rig.get(1, 0x603F, 0, "H") == 0x8130
    rig.wait(3.0)
    assert omega(rig) == 0.0


@pytest.mark.parametrize(("option", "ends"), [(0, ENABLED | FOLLOWS), (2, DISABLED), (3, DISABLED)])
def test_6007_says_what_a_lost_connection_does(rig: Host, option: int, ends: int) -> None:
    rig.put(1, 0x6007, 0, "h", option)
    rig.put(1, 0x1016, 1, "I", 0x007F0064)
    rig.enable(CST)
    rig.send(0x77F, "05")
    rig.wait(1.0)
    assert status(rig) == ends


def test_a_late_rpdo_stops_the_drive_with_8250(rig: Host) -> None:
    rig.put(1, 0x1400, 5, "H", 50)
    rig.enable(CST)
    for _ in range(10):
        rig.send(0x201, "0f 00")
        rig.wait(0.04)
    assert status(rig) == ENABLED | FOLLOWS
    assert rig.hears(0x081, 0.1) == ["50 82 11 00 00 00 00 00"]
    assert status(rig) == FAULT


def test_an_nmt_stop_while_enabled_is_a_lost_connection(rig: Host) -> None:
    rig.enable(CST)
    rig.send(0x000, "80 01")
    rig.wait(0.01)
    assert status(rig) == FAULT


def test_a_lost_heartbeat_of_a_drive_at_rest_is_told_but_no_fault(rig: Host) -> None:
    rig.put(1, 0x1016, 1, "I", 0x007F0064)
    rig.send(0x77F, "05")
    assert rig.hears(0x081, 0.2) == ["30 81 11 00 00 00 00 00"]
    assert status(rig) == DISABLED


def test_a_reboot_takes_the_torque_off_and_the_position_to_zero(rig: Host) -> None:
    rig.enable(CST)
    rig.put(1, 0x6071, 0, "h", 300)
    rig.wait(0.5)
    assert rig.get(1, 0x6064, 0, "i") > 1000
    rig.twin.drive.power_up()
    assert rig.hears(0x701, BOOTED) == ["00"]
    rig.wait(5.0)
    assert rig.twin.world.truth().tau_m == 0.0
    assert status(rig) == DISABLED
    rig.twin.drive.power_up()
    rig.wait(BOOTED)
    assert rig.get(1, 0x6064, 0, "i") == 0


def test_the_position_register_wraps_at_31_bits(rig: Host) -> None:
    rig.twin.drive.motor.offset = 2**31 - 5 - rig.twin.drive.motor.counts
    assert rig.get(1, 0x6064, 0, "i") == 2**31 - 5
    rig.twin.drive.motor.offset += 10
    assert rig.get(1, 0x6064, 0, "i") == -(2**31) + 5


def test_the_plate_agrees_with_itself(rig: Host) -> None:
    assert rig.get(1, 0x608F, 1, "I") / rig.get(1, 0x608F, 2, "I") == 10_000
    assert rig.get(1, 0x6075, 0, "I") == 6000  # mA: 3 N·m at 0.5 N·m/A
    assert rig.get(1, 0x60A8, 0, "I") == 0x00B50000
    assert rig.get(1, 0x60A9, 0, "I") == 0x00B50300
