"""Velocity and position setpoints of a CiA 402 drive: its own loops turn the motor, ours only says where to."""

from __future__ import annotations

import math
import struct

import pytest

from drivers.profile402 import counts_position, signed32, speed_unit
from drivers.targets402 import Scale
from drivers.wiring import Place
from rig.bench import read
from rig.core.channels import Flag
from rig.core.errors import Exit, NotReady
from rig.core.sample import Mode, Position, Setpoint, Torque, Velocity
from rig.procedures.coast_down import CoastDown
from rig.procedures.kinematic_error import KinematicError
from rig.process.interrupts import Interrupts
from rig.refusals import refuse_mode
from sim.wire.faults.of_bus import BusFaults
from sim.wire.servo import Motion
from sim.wire.states402 import DriveState
from tests.drivers.running import run
from tests.drivers.virtual import Wired, wired

PLACE = Place("drive", {}, counts_per_turn=10_000, torque_rated=3.0, torque_limit=5.0, speed_limit=62.8, period=1e-3)
TURN = 2 * math.pi


def connected(*overrides: str) -> Wired:
    w = wired(*overrides)
    w.instruments.connect()
    return w


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["velocity", "position"])
def test_a_slow_run_turns_the_motor_along_its_reference(mode: str):
    w = connected(f'control.mode="{mode}"')
    ending, sink = run(w)
    assert ending.exit is Exit.PASS, ending.reason
    theta = [row[0].theta_m for row in sink.rows]
    assert max(theta) - theta[0] == pytest.approx(math.radians(90), abs=math.radians(3))
    assert abs(theta[-1] - theta[0]) < math.radians(3)
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED


@pytest.mark.slow
def test_position_rows_hold_the_angles_asked_for_and_given_to_a_count():
    w = connected('control.mode="position"')
    _, sink = run(w)
    for sample, asked, applied, theta_ref in sink.rows[:-1]:
        assert asked == theta_ref
        assert applied == pytest.approx(asked, abs=0.51 * TURN / 10_000)
        assert abs(asked - sample.theta_m) < math.radians(10)
    assert math.isnan(sink.rows[-1][1])  # the torque was off: nothing was asked for


@pytest.mark.slow
def test_a_stop_in_position_mode_brings_the_motor_to_rest_and_then_lets_go():
    w = connected('control.mode="position"')
    interrupts = Interrupts()
    w.twin.agenda.after(1.0, interrupts.request)
    ending, sink = run(w, interrupts=interrupts)
    assert ending.exit is Exit.STOPPED
    assert abs(sink.rows[-1][0].omega_m) < 0.1
    assert w.twin.drive.drive_state is DriveState.SWITCH_ON_DISABLED


def test_enabling_in_position_mode_holds_the_motor_where_it_is():
    w = connected()
    drive = w.instruments.drive
    drive.enable(Mode.TORQUE)
    w.instruments.start()
    for _ in range(150):
        w.instruments.latch()
        w.instruments.read(w.wire.wait_until(w.wire.now() + 0.001))
        w.instruments.write(Torque(0.8))
    drive.halt()
    w.wire.wait_until(w.wire.now() + 0.5)
    before = w.twin.drive.motor.sample()
    assert abs(before.theta) > 0.5
    drive.enable(Mode.POSITION)
    w.wire.wait_until(w.wire.now() + 0.1)
    after: Motion = w.twin.drive.motor.sample()
    assert after.theta == pytest.approx(before.theta, abs=0.01)


def test_a_setpoint_of_another_kind_than_enabled_for_is_not_sent():
    w = connected()
    w.instruments.drive.enable(Mode.VELOCITY)
    w.instruments.latch()
    w.wire.wait_until(w.wire.now() + 0.001)
    w.instruments.drive.read()
    assert w.instruments.write(Torque(1.0)) == 0.0
    assert math.isnan(w.instruments.write(Position(1.0)))
    assert w.instruments.write(Velocity(1.0)) == pytest.approx(1.0, abs=TURN / 10_000)


@pytest.mark.parametrize(
    ("mode", "first", "then"),
    [
        (Mode.TORQUE, Torque(0.6), Torque(0.9)),
        (Mode.VELOCITY, Velocity(1.0), Velocity(2.0)),
        (Mode.POSITION, Position(0.01), Position(0.02)),
    ],
)
def test_of_a_drive_that_is_not_heard_the_setpoint_it_still_goes_by_is_told(
    mode: Mode, first: Setpoint, then: Setpoint
):
    """The row said 0 N·m, and the drive gave what it was told last."""
    w = connected()
    w.instruments.drive.enable(mode)

    def tick(setpoint: Setpoint) -> float:
        w.instruments.latch()
        w.wire.wait_until(w.wire.now() + 0.001)
        w.instruments.drive.read()
        return w.instruments.write(setpoint)

    assert tick(first) == pytest.approx(first[0], abs=1e-3)
    BusFaults(w.twin.bus).drop(0x281)  # its position
    for _ in range(4):  # the first of them may be lost: it goes on to that one
        carried = tick(then)
    sent: list[bytes] = []
    w.twin.bus.attach("ear", lambda frame, t: sent.append(frame.data) if frame.identifier == 0x201 else None)
    assert [tick(Torque(0.3) if mode is Mode.TORQUE else then) for _ in range(3)] == [carried] * 3
    assert sent == []
    assert carried == pytest.approx(then[0], abs=1e-3)


def test_a_mode_the_drive_does_not_offer_is_refused_with_its_word():
    w = connected()
    w.twin.drive.objects.find(0x6502, 0).value = 1 << 9
    w.twin.drive.mode_stuck = True
    with pytest.raises(NotReady, match=r"does not offer cyclic velocity mode \(6502h = 0x200, bit 8 is 0\)"):
        w.instruments.drive.enable(Mode.VELOCITY)
    assert w.twin.drive.drive_state is not DriveState.OPERATION_ENABLED


def test_a_mode_that_is_not_listed_and_taken_all_the_same_is_used_and_remarked_on():
    w = wired()
    w.twin.drive.objects.find(0x6502, 0).value = 0x24
    w.instruments.connect()
    assert any("bit 9 is 0); it took it all the same" in remark for remark in w.instruments.drive.remarks)
    w.instruments.drive.enable(Mode.TORQUE)
    assert w.twin.drive.drive_state is DriveState.OPERATION_ENABLED


def test_a_mode_that_was_refused_leaves_the_drive_fit_for_the_other():
    w = connected()
    w.twin.drive.objects.find(0x60A9, 0).value = 0
    with pytest.raises(NotReady, match="60A9h"):
        w.instruments.drive.enable(Mode.VELOCITY)
    w.instruments.drive.enable(Mode.TORQUE)
    assert w.twin.drive.drive_state is DriveState.OPERATION_ENABLED
    assert int(w.twin.drive.mode) == 10


def test_a_unit_of_speed_nobody_knows_is_refused():
    w = connected()
    w.twin.drive.objects.find(0x60A9, 0).value = 0
    with pytest.raises(NotReady, match=r"unit not known here \(60A9h = 00000000h\)"):
        w.instruments.drive.enable(Mode.VELOCITY)


def test_positions_in_another_unit_are_refused():
    w = wired()
    w.twin.drive.objects.find(0x60A8, 0).value = 0x00410000  # degrees
    with pytest.raises(NotReady, match=r"60A8h = 00410000h\), expected increments"):
        w.instruments.connect()


@pytest.mark.parametrize(
    ("code", "per_rad_s"),
    [
        (0x00B50300, 10_000 / TURN),  # increments per second
        (0x00B44700, 60 / TURN),  # revolutions per minute
        (0xFDB44700, 60_000 / TURN),  # thousandths of them, as EPOS4 offers
        (0x00B40300, 1 / TURN),
        (0x00000000, None),
        (0x00104700, None),
    ],
)
def test_units_of_speed(code: int, per_rad_s: float | None):
    found = speed_unit(code, 10_000)
    assert found is None if per_rad_s is None else found == pytest.approx(per_rad_s)


def test_units_of_position_and_the_register_s_wrap():
    assert counts_position(0)
    assert counts_position(0x00B50000)
    assert not counts_position(0x00410000)
    assert (signed32(2**31), signed32(-(2**31) - 1), signed32(7)) == (-(2**31), 2**31 - 1, 7)


def test_a_position_moves_on_no_faster_than_the_speed_limit():
    scale = Scale(PLACE)
    _, carried = scale.within(Mode.POSITION, 5.0, 0.001)
    assert carried == pytest.approx(0.0628, abs=TURN / 10_000)
    assert scale.clipped
    _, carried = scale.within(Mode.POSITION, math.nan, 0.001)
    assert carried == pytest.approx(0.0628, abs=TURN / 10_000)
    _, carried = scale.within(Mode.POSITION, 50.0, 5.0)  # who was away for 5 s does not make up for all of it
    assert carried == pytest.approx(11 * 0.0628, abs=TURN / 10_000)


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_no_number_asks_for_nothing(value: float):
    assert Scale(PLACE).within(Mode.TORQUE, value, 0.001) == (0, 0.0)
    assert Scale(PLACE).within(Mode.VELOCITY, value, 0.001) == (0, 0.0)
    assert Scale(PLACE).within(Mode.POSITION, value, 0.001) == (0, 0.0)


def test_the_drive_is_told_how_far_it_may_lag_and_for_how_long():
    w = connected()
    objects, limits = w.twin.drive.objects, w.bench.limits
    widest = limits.following + limits.following_time * limits.speed  # rad, of the guard
    assert objects.find(0x6065, 0).number == math.ceil(widest / TURN * 10_000)
    assert objects.find(0x6066, 0).number == 50  # ms


def test_a_motor_that_cannot_follow_in_position_mode_is_stopped_by_the_drive_itself():
    w = connected()
    drive = w.instruments.drive
    w.twin.world.lock_output()
    w.twin.drive.objects.find(0x6072, 0).value = 10  # per mille of the rated torque: too weak to wind the gear up
    drive.enable(Mode.POSITION)
    w.instruments.start()
    lagging = 0
    for tick in range(400):  # no guard here, and a reference that runs away at 60 rad/s
        w.instruments.latch()
        sample = w.instruments.read(w.wire.wait_until(w.wire.now() + 0.001))
        lagging += bool(sample.flags & Flag.SATURATED_DRIVE)
        w.instruments.write(Position(0.06 * tick))
    assert lagging >= 50  # as long as the drive puts up with it
    assert "emergency 8611h, following error" in drive.trouble
    assert w.twin.drive.drive_state is DriveState.FAULT
    assert w.twin.world.truth().tau_m == pytest.approx(0.0, abs=1e-6)


def test_a_procedure_without_a_reference_is_refused_in_words():
    bench = read("twin-canopen", ['control.mode="position"'])
    refuse_mode(bench, KinematicError())
    with pytest.raises(NotReady, match=r"coast-down asks for torques.*cannot be given position setpoints"):
        refuse_mode(bench, CoastDown())


def test_frames_on_the_wire_are_those_of_the_standard():
    w = connected()
    w.instruments.drive.enable(Mode.POSITION)
    w.instruments.latch()
    w.wire.wait_until(w.wire.now() + 0.001)
    w.instruments.drive.read()
    seen: list[bytes] = []
    w.twin.bus.attach("ear", lambda frame, t: seen.append(frame.data) if frame.identifier == 0x201 else None)
    w.instruments.write(Position(-TURN / 100))
    w.wire.wait_until(w.wire.now() + 0.001)
    assert seen == [struct.pack("<Hi", 0x0F, -100)]


def test_a_drive_that_does_nothing_when_its_host_falls_silent_is_told_to_fault_or_counts_as_unguarded():
    w = wired()
    silent = w.twin.drive.objects.find(0x6007, 0)
    silent.value = 0
    w.instruments.connect()
    assert silent.number == 1
    assert w.instruments.drive.watchdog.words.startswith("heartbeat consumer")
    w = wired()
    silent = w.twin.drive.objects.find(0x6007, 0)
    silent.value, silent.writable = 0, False
    w.instruments.connect()
    assert w.instruments.drive.watchdog.words == ""
    assert any("when this program falls silent" in remark for remark in w.instruments.drive.remarks)
