"""Friction at rest: it holds truly, lets go at its breakaway torque, and makes a weak loop stick and slip."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import numpy.typing as npt
import pytest

from rig.control.filter import SpeedFilter
from rig.control.pid import Pid
from rig.control.profile import Triangle
from rig.core.gains import Gains
from rig.core.sample import Torque
from sim import kernel
from sim.drive import TwinDrive
from sim.parameters import TwinParameters
from sim.plant import Plant
from sim.world import World
from tests.sim.conftest import with_gear

TICK = 1e-3  # s


def advance(plant: Plant, seconds: float, tau: float) -> None:
    for _ in range(round(seconds / TICK)):
        plant.advance(TICK, tau)


@pytest.mark.slow
def test_below_breakaway_the_motor_does_not_move_at_all(calm: TwinParameters) -> None:
    plant = Plant(calm, theta_m=12.3)
    start = plant.truth()
    for tau in (0.499, -0.499):
        advance(plant, 50.0, tau)
        assert plant.truth()[:4] == start[:4]
    assert plant.ledger().motor == 0.0


@pytest.mark.slow
def test_below_its_friction_the_load_does_not_move_at_all(calm: TwinParameters) -> None:
    plant = Plant(calm, theta_m=12.3)
    start = plant.truth()
    plant.tau_ext = 0.999
    advance(plant, 100.0, 0.0)
    assert plant.truth()[:4] == start[:4]


def test_a_held_motor_keeps_its_angle_while_the_load_swings(calm: TwinParameters) -> None:
    plant = Plant(calm, theta_m=12.3)
    plant.tau_ext = 5.0
    speeds = []
    for _ in range(200):
        plant.advance(TICK, 0.0)
        x = plant.truth()
        assert (x.theta_m, x.omega_m) == (12.3, 0.0)
        speeds.append(x.omega_l)
    assert min(speeds) < 0.0 < max(speeds)  # 24 Hz against a motor at rest, until the load's friction holds it
    assert speeds[-1] == 0.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_motor_breaks_away_at_its_breakaway_torque(calm: TwinParameters, sign: float) -> None:
    plant, tau = Plant(calm, theta_m=0.7), 0.0
    while plant.truth().omega_m == 0.0:
        tau += 1e-5
        plant.advance(TICK, sign * tau)
    assert tau == pytest.approx(calm.gear.tau_s, abs=3e-5)
    assert sign * plant.truth().omega_m > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_load_breaks_away_at_its_friction_torque(calm: TwinParameters, sign: float) -> None:
    plant, tau = Plant(calm, theta_m=0.7), 0.0
    while plant.truth().omega_l == 0.0:
        tau += 1e-5
        plant.tau_ext = sign * tau
        plant.advance(TICK, 0.0)
    assert tau == pytest.approx(calm.gear.F_cl, abs=3e-5)
    assert sign * plant.truth().omega_l > 0.0


def test_breakaway_inside_a_step_falls_at_its_instant(calm: TwinParameters) -> None:
    # The drive's torque rises as 1 − e^{−t/T}: it reaches τ_s at t* = T·ln 2 when told 2·τ_s. From there on the
    # motor accelerates; one step across t* must equal two steps that meet there.
    tau, instant = 2 * calm.gear.tau_s, calm.tau_drive * math.log(2.0)
    whole, halves = Plant(calm, refine=4.0), Plant(calm, refine=4.0)
    whole.advance(2 * TICK, tau)
    halves.advance(instant, tau)
    assert halves.truth().omega_m == 0.0
    halves.advance(2 * TICK - instant, tau)
    assert whole.truth().omega_m > 0.1
    assert whole.truth().omega_m == pytest.approx(halves.truth().omega_m, rel=1e-9)


def test_a_coasting_motor_stops_where_constant_friction_says(calm: TwinParameters) -> None:
    # Coulomb friction alone, no gear to speak of: θ = J·ω²/(2·τ_c), reached at t = J·ω/τ_c, then rest
    bare = with_gear(calm, K=1e-6, tau_s=0.3, B_m=0.0, B_ml=0.0, B_sp=0.0, B_l=0.0)
    plant = Plant(bare)
    plant.place(0.0, 5.0)
    advance(plant, 0.1, 0.0)
    x = plant.truth()
    assert x.omega_m == 0.0
    assert x.theta_m == pytest.approx(calm.gear.J_m * 5.0**2 / (2 * 0.3), rel=1e-8)


def test_reversal_through_rest_happens_without_a_pause_when_torque_is_large(calm: TwinParameters) -> None:
    plant = Plant(calm)
    plant.place(0.0, 2.0)
    signs = []
    for _ in range(20):
        plant.advance(TICK, -2.0)
        signs.append(math.copysign(1.0, plant.truth().omega_m))
    assert signs == sorted(signs, reverse=True)
    assert plant.truth().omega_m < -2.0


def follow_triangle(parameters: TwinParameters, gains: Gains, seconds: float) -> npt.NDArray[np.float64]:
    """True motor speeds, one a tick, while the host's position loop follows the slow triangle over the twin's drive."""
    world = World(parameters, seed=4)
    drive, pid, speed = TwinDrive(world), Pid(gains, TICK), SpeedFilter(0.008)
    reference, speeds = Triangle(8 * math.pi, 0.01, 1), []
    drive.connect()
    drive.enable()
    for k in range(1, round(seconds / TICK)):
        world.wait_until(k * TICK)
        reading = drive.read()
        theta_ref, omega_ref = reference.at(reading.t)
        omega = speed.step(reading.t, reading.theta_m)
        drive.write(Torque(pid.step(theta_ref, omega_ref, reading.theta_m, omega)))
        speeds.append(world.plant.motor[1])
    return np.array(speeds)


def test_a_weak_loop_sticks_and_slips_where_friction_falls_slowly_with_speed(twin: TwinParameters) -> None:
    weak = Gains(Kp=0.3, Ki=1.0, Kd=0.005, integrator_limit=1.5, torque_limit=5.0)
    speeds = follow_triangle(with_gear(twin, omega_s=1.5), weak, 20.0)[5000:]
    assert 0.3 < np.mean(speeds == 0.0) < 0.95  # sticks most of the time …
    assert speeds.max() > 3.0  # … and slips three times as fast as asked
    starts = np.sum((speeds[:-1] == 0.0) & (speeds[1:] > 0.0))
    assert starts > 3


def test_the_bench_loop_turns_steadily_through_the_same_friction(twin: TwinParameters) -> None:
    gains = Gains(Kp=3.0, Ki=30.0, Kd=0.12, integrator_limit=1.5, torque_limit=5.0, feedforward=0.0033)
    speeds = follow_triangle(twin, gains, 10.0)[3000:]
    asked = Triangle(8 * math.pi, 0.01, 1).speed
    assert speeds.min() > 0.5 * asked
    assert np.mean(speeds) == pytest.approx(asked, rel=0.01)
    assert np.std(speeds) < 0.1 * asked


@pytest.mark.slow
def test_friction_wanders_by_its_sigma_with_its_correlation_time(twin: TwinParameters) -> None:
    parameters = dataclasses.replace(twin, friction_noise=0.05, friction_noise_s=0.1)
    plant, rng = Plant(parameters), np.random.default_rng(3)
    wander = []
    for _ in range(50_000):
        plant.advance(TICK, 0.0, *rng.standard_normal(2))
        wander.append(plant.state[[kernel.WANDER_M, kernel.WANDER_L]].copy())
    both = np.array(wander)[1000:]
    lag = round(0.1 / TICK)
    for series in both.T:
        assert np.std(series) == pytest.approx(0.05, rel=0.15)
        assert np.corrcoef(series[:-lag], series[lag:])[0, 1] == pytest.approx(math.exp(-1.0), abs=0.15)
    assert abs(np.corrcoef(both.T)[0, 1]) < 0.25  # the two sides know nothing of each other


def test_what_holds_a_side_wanders_with_its_own_friction(calm: TwinParameters) -> None:
    plant = Plant(dataclasses.replace(calm, friction_noise_s=1e12), theta_m=0.7)
    plant.state[[kernel.WANDER_M, kernel.WANDER_L]] = 0.2, 0.3
    plant.tau_ext = 1.299 * calm.gear.F_cl
    advance(plant, 1.0, 0.0)
    assert plant.truth().omega_l == 0.0
    plant.tau_ext = 1.301 * calm.gear.F_cl
    plant.advance(TICK, 0.0)
    assert plant.truth().omega_l > 0.0
    plant.place(0.7)
    plant.state[kernel.WANDER_M] = 0.2
    plant.tau_ext = 0.0
    advance(plant, 1.0, 1.199 * calm.gear.tau_s)
    assert plant.truth().omega_m == 0.0
    advance(plant, 0.02, 1.201 * calm.gear.tau_s)
    assert plant.truth().omega_m > 0.0
