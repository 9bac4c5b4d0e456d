"""Load encoder and torque sensor: grid, latch, low-pass, noise, range, and what can go wrong with them."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rig.core.channels import Flag
from sim.faults import Frozen, Jump, Overload, Scale, Silent
from sim.noise import normal
from sim.parameters import TwinParameters
from sim.sensors import TwinLoadEncoder, TwinTorqueSensor
from sim.world import World
from tests.sim.conftest import FRICTIONLESS, with_gear

TICK = 1e-3  # s


def turning(parameters: TwinParameters, omega_m: float = 31.4) -> tuple[World, TwinLoadEncoder, TwinTorqueSensor]:
    world = World(parameters, 3)
    encoder, sensor = TwinLoadEncoder(world), TwinTorqueSensor(world)
    encoder.connect()
    sensor.connect()
    world.plant.place(world.truth().theta_m, omega_m)
    return world, encoder, sensor


def perfect(twin: TwinParameters, **changes: float) -> TwinParameters:
    """A torque sensor without noise, offset and grid."""
    none = {"sensor_noise": 0.0, "sensor_zero": 0.0, "sensor_resolution": 0.0, "friction_noise": 0.0}
    return dataclasses.replace(twin, **{**none, **changes})


def test_the_load_angle_is_counted_down_to_whole_counts(twin: TwinParameters) -> None:
    world, encoder, _ = turning(twin)
    step = 2 * math.pi / 900_000
    for k in range(1, 300):
        world.wait_until(k * TICK)
        reading, x = encoder.read(), world.truth()
        latched = x.theta_l + x.omega_l * twin.latch_l - encoder.encoder.zero
        assert reading.theta == reading.counts * step
        assert -0.001 * step < latched - reading.theta < 1.001 * step
        assert reading.flags == Flag.SIMULATED
    assert encoder.read().counts > 1000


@pytest.mark.parametrize("latch", [0.0, 2e-6, 5e-5, 3e-4])
def test_the_load_angle_is_that_of_its_latch_time(twin: TwinParameters, latch: float) -> None:
    fine = dataclasses.replace(twin, latch_l=latch, load_counts_per_turn=10**10, friction_noise=0.0)
    world, encoder, _ = turning(fine)
    world.wait_until(0.02)
    reading = encoder.read()
    assert reading.t == 0.02 + latch
    world.wait_until(reading.t)
    assert reading.theta == pytest.approx(world.truth().theta_l - encoder.encoder.zero, abs=2e-9)  # of 7e-6 a count


def test_the_torque_is_that_of_its_latch_time_behind_the_low_pass(twin: TwinParameters) -> None:
    swinging = perfect(with_gear(twin, **FRICTIONLESS), latch_tau=5e-4, sensor_lowpass_hz=60.0)
    world, _, sensor = turning(swinging, 50.0)
    reference = World(swinging, 3)
    reference.plant.place(reference.truth().theta_m, 50.0)
    filtered, t, fine, lag, lags = reference.plant.shaft[3], 0.0, 5e-6, 1 / (2 * math.pi * 60.0), []
    for k in range(1, 40):
        world.wait_until(k * TICK)
        reading = sensor.read()
        while t < reading.t - fine / 2:  # the low-pass again, by small steps through the true torque
            before = reference.truth().tau_l
            t += fine
            reference.wait_until(t)
            middle = (before + reference.truth().tau_l) / 2
            filtered = middle + (filtered - middle) * math.exp(-fine / lag)
        lags.append(abs(reference.truth().tau_l - filtered))
        assert reading.tau == pytest.approx(filtered, abs=0.003)
    assert max(lags) > 0.3


def test_the_low_pass_has_the_stated_corner(twin: TwinParameters) -> None:
    # locked output, motor swung at f: the shaft torque's amplitude behind 1/(1 + jf/f_c)
    slow = perfect(with_gear(twin, B_m=0.2, **FRICTIONLESS), sensor_lowpass_hz=10.0, latch_tau=0.0)
    world, _, sensor = turning(slow, 0.0)
    world.lock_output()
    seen, true, times = [], [], []
    for k in range(1, 4000):
        t = k * 2.5e-4
        world.command(0.2 * math.sin(2 * math.pi * 10.0 * t))
        world.wait_until(t)
        if t > 0.5:
            seen.append(sensor.read().tau)
            true.append(world.truth().tau_l)
            times.append(t)
    wave = np.exp(-2j * np.pi * 10.0 * np.array(times))
    keep = len(times) // 400 * 400  # whole periods
    ratio = np.mean(np.array(seen)[:keep] * wave[:keep]) / np.mean(np.array(true)[:keep] * wave[:keep])
    assert abs(ratio) == pytest.approx(1 / math.sqrt(2), rel=0.01)
    assert np.angle(ratio) == pytest.approx(-math.pi / 4, abs=0.01)


def test_a_torque_at_rest_reads_offset_and_noise_on_a_grid(twin: TwinParameters) -> None:
    world, _, sensor = turning(twin, 0.0)
    readings = []
    for k in range(1, 3000):
        world.wait_until(k * TICK)
        readings.append(sensor.read())
    tau = np.array([r.tau for r in readings])
    assert np.mean(tau) == pytest.approx(twin.sensor_zero, abs=4 * twin.sensor_noise / 3000**0.5)
    assert np.std(tau) == pytest.approx(twin.sensor_noise, rel=0.05)
    steps = tau / twin.sensor_resolution
    assert np.allclose(steps, np.round(steps), atol=1e-9)
    assert all(r.flags == Flag.SIMULATED for r in readings)
    assert abs(np.corrcoef(tau[1:], tau[:-1])[0, 1]) < 0.06  # white at the loop's rate


def test_positive_means_the_gear_drives_the_load_forward(twin: TwinParameters) -> None:
    world, _, sensor = turning(perfect(twin), 0.0)
    world.lock_output()
    world.command(1.0)
    world.wait_until(0.5)
    assert sensor.read().tau > 10.0
    world.command(-1.0)
    world.wait_until(1.0)
    assert sensor.read().tau < -10.0


@pytest.mark.parametrize("sign", [1, -1])
def test_beyond_its_range_the_torque_sensor_saturates_and_says_so(twin: TwinParameters, sign: int) -> None:
    world, _, sensor = turning(dataclasses.replace(twin, sensor_range=2.0), 0.0)
    world.lock_output()
    world.command(sign * 1.0)
    world.wait_until(0.5)
    reading = sensor.read()
    assert reading.tau == pytest.approx(sign * 2.0, abs=twin.sensor_resolution)
    assert reading.flags == Flag.SIMULATED | Flag.SATURATED_TAU


def test_the_torque_sensor_can_be_overloaded_by_a_fault(twin: TwinParameters) -> None:
    world, _, sensor = turning(twin)
    sensor.fault = Overload(-1)
    world.wait_until(TICK)
    assert sensor.read().tau == pytest.approx(-50.0, abs=twin.sensor_resolution)
    assert sensor.read().flags == Flag.SIMULATED | Flag.SATURATED_TAU
    sensor.fault = None
    world.wait_until(2 * TICK)
    assert sensor.read().flags == Flag.SIMULATED


def test_silent_and_frozen_sensors_differ_in_their_time(twin: TwinParameters) -> None:
    world, encoder, sensor = turning(twin)
    world.wait_until(TICK)
    before = encoder.read(), sensor.read()
    encoder.fault, sensor.fault = Silent(), Frozen()
    world.wait_until(2 * TICK)
    held = sensor.read()
    world.wait_until(0.1)
    assert encoder.read() == before[0]
    assert sensor.read().t > held.t > before[1].t
    assert sensor.read().tau == held.tau


def test_a_slipped_a_reversed_and_a_misscaled_load_encoder(twin: TwinParameters) -> None:
    world, encoder, _ = turning(twin)
    world.wait_until(0.5)
    true = world.truth().theta_l - encoder.encoder.zero
    assert true > 0.02
    for fault, expected in ((Jump(0.01), true + 0.01), (Scale(-1.0), -true), (Scale(1.5), 1.5 * true)):
        fresh = TwinLoadEncoder(world)
        fresh.encoder, fresh.fault = encoder.encoder, fault
        fresh.connect()
        assert fresh.read().theta == pytest.approx(expected, abs=1e-5)


def test_streams_of_noise_differ_by_purpose_and_by_seed() -> None:
    draws = [normal(*key) for key in ((1, "a"), (1, "b"), (2, "a"))]
    series = np.array([[draw() for _ in range(5000)] for draw in draws])
    assert np.max(np.abs(np.corrcoef(series) - np.eye(3))) < 0.06
    assert np.std(series) == pytest.approx(1.0, abs=0.02)


def test_each_channels_noise_is_its_own(twin: TwinParameters) -> None:
    alone, together = turning(twin)[2], turning(twin)
    for k in range(1, 50):
        alone.world.wait_until(k * TICK)
        together[0].wait_until(k * TICK)
        together[1].read()
        assert alone.read() == together[2].read()
