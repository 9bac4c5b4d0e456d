"""The twin's drive: resolution, limit, watchdog, faults, and an encoder that knows no absolute angle."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rig.core.channels import Flag
from rig.core.errors import HdrigError, NotReady
from rig.core.sample import Torque
from sim.drive import TwinDrive
from sim.faults import Frozen, Jump, Scale, Silent
from sim.parameters import TwinParameters
from sim.world import World

TICK = 1e-3  # s


@pytest.fixture
def world(twin: TwinParameters) -> World:
    return World(twin, 2)


@pytest.fixture
def drive(world: World) -> TwinDrive:
    drive = TwinDrive(world)
    drive.connect()
    return drive


def hold(drive: TwinDrive, tau: float, seconds: float) -> None:
    for _ in range(round(seconds / TICK)):
        drive.write(Torque(tau))
        drive.world.wait_until(drive.world.now() + TICK)


def test_a_command_is_rounded_to_what_the_frame_can_carry(drive: TwinDrive) -> None:
    drive.enable()
    assert drive.write(Torque(0.1)) == pytest.approx(0.099)
    assert drive.write(Torque(-0.1006)) == pytest.approx(-0.102)
    assert drive.write(Torque(0.0014)) == 0.0


def test_a_command_beyond_the_limit_is_clipped_and_flagged(drive: TwinDrive) -> None:
    drive.enable()
    for asked in (7.0, -7.0, math.inf):
        carried = drive.write(Torque(asked))
        assert abs(carried) <= 5.0  # 5 N·m is no whole number of steps
        assert carried == pytest.approx(math.copysign(4.998, asked))
        drive.world.wait_until(drive.world.now() + TICK)
        assert drive.read().flags == Flag.SIMULATED | Flag.SATURATED_DRIVE
    drive.write(Torque(1.0))
    drive.world.wait_until(drive.world.now() + TICK)
    assert drive.read().flags == Flag.SIMULATED


def test_a_torque_that_is_no_number_is_refused(drive: TwinDrive) -> None:
    drive.enable()
    with pytest.raises(HdrigError, match="not a number"):
        drive.write(Torque(math.nan))


def test_nothing_is_carried_unless_enabled(drive: TwinDrive) -> None:
    assert drive.write(Torque(1.0)) == 0.0
    drive.world.wait_until(0.1)
    assert drive.world.truth().tau_m == 0.0


def test_enabling_energises_with_zero_torque_and_twice_changes_nothing(drive: TwinDrive) -> None:
    drive.enable()
    drive.world.wait_until(0.005)
    assert drive.world.truth().tau_m == 0.0
    drive.write(Torque(0.3))
    drive.enable()
    drive.world.wait_until(0.010)
    assert drive.world.truth().tau_m == pytest.approx(0.3, rel=1e-3)


def test_the_reported_torque_is_the_true_one_with_noise_on_a_grid(drive: TwinDrive, twin: TwinParameters) -> None:
    drive.enable()
    hold(drive, 0.3, 0.05)
    reported = []
    for _ in range(2000):
        hold(drive, 0.3, TICK)
        reported.append(drive.read().tau_m)
    steps = np.array(reported) / twin.torque_resolution
    assert np.allclose(steps, np.round(steps), atol=1e-9)
    assert np.mean(reported) == pytest.approx(0.3, abs=5e-4)
    assert np.std(reported) == pytest.approx(np.hypot(twin.torque_noise, twin.torque_resolution / 12**0.5), rel=0.1)


def test_without_commands_the_watchdog_lets_go_and_latches(drive: TwinDrive, twin: TwinParameters) -> None:
    drive.enable()
    hold(drive, 0.3, 0.01)
    last = drive.world.now()
    drive.write(Torque(0.3))
    drive.world.wait_until(last + 0.9 * twin.watchdog)
    assert drive.read().fault == ""
    drive.world.wait_until(last + 1.5 * twin.watchdog)
    assert drive.read().fault == f"watchdog: no command for {1e3 * twin.watchdog:g} ms"
    assert drive.write(Torque(0.3)) == 0.0
    drive.world.wait_until(last + 2.0 * twin.watchdog)
    assert abs(drive.world.truth().tau_m) < 1e-9


def test_the_watchdog_starts_with_the_first_command(drive: TwinDrive) -> None:
    # the world may lie far behind a wall clock when the drive is enabled; no torque flows until the first command
    drive.enable()
    drive.world.advance_to(3.0)
    assert drive.read().fault == ""
    assert drive.write(Torque(0.3)) == pytest.approx(0.3)
    drive.world.advance_to(3.5)
    assert drive.read().fault.startswith("watchdog")


def test_a_latched_fault_refuses_to_enable_until_reset_and_reset_never_energises(drive: TwinDrive) -> None:
    drive.enable()
    drive.trip("overcurrent")
    drive.trip("a consequence of it")
    assert drive.read().fault == "overcurrent"
    with pytest.raises(NotReady, match="overcurrent; reset the fault first"):
        drive.enable()
    drive.reset_fault()
    assert drive.read().fault == ""
    assert drive.write(Torque(0.3)) == 0.0
    drive.enable()
    assert drive.write(Torque(0.3)) == pytest.approx(0.3)


def test_a_halted_drive_needs_no_commands(drive: TwinDrive) -> None:
    drive.enable()
    drive.write(Torque(0.4))
    assert drive.halt() is True
    drive.world.wait_until(1.0)
    assert drive.read().fault == ""
    assert abs(drive.world.truth().tau_m) < 1e-9


def test_a_deaf_drive_holds_its_torque_confirms_nothing_and_ends_by_its_watchdog(drive: TwinDrive) -> None:
    drive.enable()
    hold(drive, 0.3, 0.01)
    drive.deaf = True
    assert drive.write(Torque(0.0)) == 0.0
    assert drive.halt() is False
    drive.world.wait_until(drive.world.now() + 0.01)
    assert drive.world.truth().tau_m == pytest.approx(0.3)
    drive.world.wait_until(drive.world.now() + drive.world.parameters.watchdog)
    assert drive.read().fault.startswith("watchdog")
    assert abs(drive.world.truth().tau_m) < 1e-6
    with pytest.raises(NotReady, match="watchdog"):
        drive.enable()


def test_the_encoder_counts_from_power_up_and_its_zero_is_known_to_the_truth(drive: TwinDrive) -> None:
    first = drive.read()
    assert (first.counts, first.theta_m) == (0, 0.0)
    drive.enable()
    step = 2 * math.pi / 10_000
    for _ in range(300):
        hold(drive, 0.7, TICK)
        reading, true = drive.read(), drive.world.truth().theta_m - drive.encoder.zero
        assert reading.theta_m == reading.counts * step
        assert 0.0 <= true - reading.theta_m < step * (1 + 1e-9)
    assert drive.read().counts > 1000


def test_the_phase_of_the_encoder_differs_from_seed_to_seed(twin: TwinParameters) -> None:
    zeros = [TwinDrive(World(twin, seed)).encoder.zero % (2 * math.pi) for seed in range(6)]
    assert np.ptp(zeros) > 1.0


def test_a_reading_says_when_it_was_latched_and_where_the_motor_was_then(twin: TwinParameters) -> None:
    world = World(dataclasses.replace(twin, latch_m=2e-4, motor_counts_per_turn=10**9, friction_noise=0.0), 2)
    drive = TwinDrive(world)
    drive.connect()
    world.plant.place(drive.encoder.zero, 30.0)
    world.wait_until(0.01)
    reading = drive.read()
    assert reading.t == 0.01 + 2e-4
    world.wait_until(reading.t)
    true = world.truth().theta_m - drive.encoder.zero
    assert reading.theta_m == pytest.approx(true, abs=3e-8)  # a ten-thousandth of the real encoder's count
    assert 30.0 * 2e-4 > 1e5 * 3e-8  # which is far less than the motor has moved


def test_the_same_instant_gives_the_same_reading(drive: TwinDrive) -> None:
    drive.world.wait_until(0.01)
    assert drive.read() is drive.read()


def moving(drive: TwinDrive) -> None:
    drive.enable()
    hold(drive, 0.7, 0.05)


def test_a_silent_channel_repeats_its_last_reading(drive: TwinDrive) -> None:
    moving(drive)
    last = drive.read()
    drive.fault = Silent()
    hold(drive, 0.7, 0.01)
    assert drive.read() == last
    drive.fault = None
    hold(drive, 0.7, 0.01)
    assert drive.read().t > last.t


def test_a_frozen_channel_goes_on_in_time_but_not_in_value(drive: TwinDrive) -> None:
    moving(drive)
    drive.fault = Frozen()
    hold(drive, 0.7, TICK)
    first = drive.read()
    hold(drive, 0.7, 0.01)
    second = drive.read()
    assert second.t > first.t
    assert second.counts == first.counts


def test_a_jump_moves_angle_and_counts_together(drive: TwinDrive) -> None:
    moving(drive)
    true = drive.world.truth().theta_m - drive.encoder.zero
    drive.fault = Jump(math.pi / 2)
    hold(drive, 0.7, TICK)
    moved = drive.world.truth().theta_m - drive.encoder.zero - true
    assert drive.read().theta_m == pytest.approx(true + moved + math.pi / 2, abs=1e-3)
    assert drive.read().counts == pytest.approx((true + moved + math.pi / 2) * 10_000 / (2 * math.pi), abs=1.5)


@pytest.mark.parametrize(
    ("fault", "factor"), [(Scale(-1.0), -1.0), (Scale(2.0), 2.0), (Scale(50.0 / 51.0), 50.0 / 51.0)]
)
def test_a_reversed_or_misscaled_encoder_is_wrong_from_power_up_on(
    drive: TwinDrive, fault: Scale, factor: float
) -> None:
    drive.fault = fault
    moving(drive)
    true = drive.world.truth().theta_m - drive.encoder.zero
    assert true > 0.1
    assert drive.read().theta_m == pytest.approx(factor * true, abs=1.5e-3)
