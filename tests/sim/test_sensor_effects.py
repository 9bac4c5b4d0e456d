"""What the twin's sensors add: scales off their centre, interpolation, skew, crosstalk, drift, pickup, lost counts."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from sim.drive import TwinDrive
from sim.effects import Effects, Sensors
from sim.faults import MissedCounts
from sim.parameters import TwinParameters
from sim.sensors import TwinLoadEncoder, TwinTorqueSensor
from sim.world import World
from tests.sim.conftest import with_gear

TICK = 1e-3  # s
FINE = 10**9  # counts per turn: none of its steps in the way


def bare(twin: TwinParameters, **sensors: float) -> TwinParameters:
    """Sensors without noise and grid, but for `sensors`."""
    none = {"sensor_noise": 0.0, "sensor_zero": 0.0, "sensor_resolution": 0.0, "friction_noise": 0.0}
    fine = {"motor_counts_per_turn": FINE, "load_counts_per_turn": FINE}
    return dataclasses.replace(twin, **none, **fine, effects=Effects(sensors=Sensors(**sensors)))


def devices(parameters: TwinParameters, omega_m: float) -> tuple[World, TwinDrive, TwinLoadEncoder, TwinTorqueSensor]:
    world = World(parameters, 3)
    drive, encoder, sensor = TwinDrive(world), TwinLoadEncoder(world), TwinTorqueSensor(world)
    for device in (drive, encoder, sensor):
        device.connect()
    world.plant.place(world.truth().theta_m, omega_m)
    return world, drive, encoder, sensor


def test_an_eccentric_load_scale_shows_once_and_twice_per_turn_in_the_angle_alone(twin: TwinParameters) -> None:
    shape = {"load_eccentricity_deg": 0.01, "load_eccentricity_phase_deg": 30.0, "load_ellipticity_deg": 0.002}
    parameters = bare(twin, **shape)
    world, _, encoder, _ = devices(parameters, 0.0)
    for k in range(1, 60):
        world.plant.place(5.5 * k, 0.0)
        world.wait_until(k * TICK)
        theta = world.truth().theta_l
        expected = theta + math.radians(0.01) * math.sin(theta - math.radians(30.0))
        expected += math.radians(0.002) * math.sin(2 * theta)
        assert encoder.read().theta + encoder.encoder.zero == pytest.approx(expected, abs=2e-8)
    straight, turned = World(bare(twin), 3), World(parameters, 3)
    for w in (straight, turned):
        w.command(0.5)
        w.wait_until(0.3)
    assert straight.truth() == turned.truth()  # nothing turns by it


def test_an_eccentric_motor_scale_shows_once_per_motor_turn_at_any_speed(twin: TwinParameters) -> None:
    amplitudes = []
    for omega in (2.0, 30.0):
        world, drive, _, _ = devices(bare(twin, motor_eccentricity_deg=0.1), omega)
        rows = []
        for k in range(1, 400):
            world.wait_until(k * TICK)
            world.command(0.4)
            theta = world.truth().theta_m
            rows.append((theta, drive.read().theta_m + drive.encoder.zero - theta))
        theta, error = np.array(rows).T
        columns = np.array([np.sin(theta), np.cos(theta)]).T
        amplitudes.append(np.hypot(*np.linalg.lstsq(columns, error, rcond=None)[0]))
    np.testing.assert_allclose(np.degrees(amplitudes), 0.1, rtol=1e-3)


def test_interpolation_repeats_with_every_line(twin: TwinParameters) -> None:
    lines = 2500
    world, drive, _, _ = devices(bare(twin, motor_interpolation_deg=0.002, motor_lines=lines), 0.0)
    for k in range(1, 80):
        world.plant.place(0.0131 * k, 0.0)
        world.wait_until(k * TICK)
        theta = world.truth().theta_m
        error = drive.read().theta_m + drive.encoder.zero - theta
        assert error == pytest.approx(math.radians(0.002) * math.sin(lines * theta), abs=2e-8)


@pytest.mark.parametrize("skew", [-5e-4, 5e-4])
def test_a_skewed_channel_shows_another_time_than_it_says(twin: TwinParameters, skew: float) -> None:
    for channel in ("motor_skew", "load_skew"):
        world, drive, encoder, _ = devices(bare(twin, **{channel: skew}), 50.0)
        reference = World(bare(twin), 3)
        reference.plant.place(reference.truth().theta_m, 50.0)
        world.wait_until(0.02)
        reading = drive.read() if channel == "motor_skew" else encoder.read()
        assert reading.t == 0.02 + (twin.latch_m if channel == "motor_skew" else twin.latch_l)
        reference.wait_until(reading.t + skew)
        x = reference.truth()
        if channel == "motor_skew":
            assert drive.read().theta_m + drive.encoder.zero == pytest.approx(x.theta_m, abs=1e-6)  # it turned 0.025
        else:
            assert encoder.read().theta + encoder.encoder.zero == pytest.approx(x.theta_l, abs=5e-8)  # of 5e-4


@pytest.mark.parametrize("skew", [-1e-3, 1e-3])
def test_a_skewed_torque_is_that_of_another_time(twin: TwinParameters, skew: float) -> None:
    quiet = with_gear(bare(twin, torque_skew=skew), B_m=0.05, tau_c=0.0, tau_s=0.0)
    world, _, _, sensor = devices(quiet, 0.0)
    reference = World(with_gear(bare(twin), B_m=0.05, tau_c=0.0, tau_s=0.0), 3)
    for w in (world, reference):
        w.lock_output()
        w.command(0.4)
    misses = []
    for k in range(30, 60):
        world.wait_until(k * TICK)
        reading = sensor.read()
        reference.wait_until(reading.t + skew)
        misses.append((reading.tau - reference.plant.shaft[3], reference.plant.shaft[2] * skew))
    miss, moved = np.abs(np.array(misses)).max(axis=0)
    assert miss < 0.1 * moved


def test_bending_shows_in_the_torque_sensor_once_and_twice_per_output_turn(twin: TwinParameters) -> None:
    shape = {"crosstalk": 0.1, "crosstalk_phase_deg": 40.0, "crosstalk_second": 0.05}
    world, _, _, sensor = devices(bare(twin, **shape), 0.0)
    for k in range(1, 60):
        world.plant.place(5.5 * k, 0.0)
        world.wait_until(k * TICK)
        x = world.truth()
        expected = x.tau_l + 0.1 * math.cos(x.theta_l - math.radians(40.0)) + 0.05 * math.cos(2 * x.theta_l)
        assert sensor.read().tau == pytest.approx(expected, abs=1e-6)


def test_the_zero_drifts_and_mains_are_picked_up_at_a_standstill(twin: TwinParameters) -> None:
    shape = {"zero_drift": 0.2, "zero_drift_time": 2.0, "pickup": 0.05, "pickup_hz": 50.0}
    world, _, _, sensor = devices(bare(twin, **shape), 0.0)
    rows = []
    for k in range(1, 6001):
        world.wait_until(k * TICK)
        rows.append(sensor.read().tau)
    tau, t = np.array(rows), TICK * np.arange(1, 6001)
    t += twin.latch_tau
    np.testing.assert_allclose(tau, 0.2 * (1 - np.exp(-t / 2.0)) + 0.05 * np.sin(2 * np.pi * 50.0 * t), atol=1e-6)


def test_counts_that_go_missing_leave_a_step_each_and_never_come_back(twin: TwinParameters) -> None:
    world, drive, _, _ = devices(dataclasses.replace(twin, friction_noise=0.0), 0.0)
    step = 2 * math.pi / 10_000
    drive.fault = MissedCounts(step, every=math.pi)
    behind = []
    for theta in (0.0, 2.0, 4.0, 8.0, 4.0, 0.0):  # π is passed once, twice (2π), then on the way back
        world.plant.place(drive.encoder.zero + theta + 1e-5, 0.0)
        world.wait_until(world.now() + TICK)
        behind.append(round((theta - drive.read().theta_m) / step))
    assert behind == [0, 0, 1, 2, 1, -1]
