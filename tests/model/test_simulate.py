"""The simulator against DOP853, the closed forms, the power balance, the figures of the paper's rig and the twin."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import solve_ivp

from rig.bench import read, twin_parameters
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import transmissibility
from rig.model.simulate import (
    NoSteadyState,
    Start,
    Waveform,
    at_speed,
    steady_state,
    torque_for,
    under_motion,
    under_torque,
)

Array = npt.NDArray[np.float64]
RPM, DEG = math.pi / 30, 180 / math.pi
TABLE = {  # rpm: p-p of θ̃, p-p of θ̃_s, C_2, C_4, all deg; spring torque p-p N·m; by another program, simulated in time
    120: (0.0315, 0.0069, 0.01128, 0.00289, 0.87),
    300: (0.0413, 0.0233, 0.01306, 0.00696, 2.9),
    500: (0.0526, 0.0366, 0.01955, 0.00338, 4.6),
}


@pytest.fixture(scope="module")
def gear() -> Gear:
    found: Gear = twin_parameters(read("twin").file).gear
    return found


def dop853(gear: Gear, start: tuple[float, float, float, float], times: Array, tau: float) -> Array:
    """(θ_m, θ_l, ω_m, ω_l) at `times`, (4, n), while both sides slide forward; forces written anew."""
    series = gear.kinematic_error

    def rate(_: float, x: Array) -> list[float]:
        lever = float(series.slope(np.array(x[0]))) - 1 / gear.ratio
        phi = x[1] - x[0] / gear.ratio + float(series.value(np.array(x[0])))
        spring = gear.K * phi + gear.B_sp * (x[3] + lever * x[2])
        mesh = gear.B_ml * (x[2] + gear.sigma * x[3])
        rub = gear.tau_c + (gear.tau_s - gear.tau_c) * math.exp(-((x[2] / gear.omega_s) ** 2))
        motor = (tau - spring * lever - mesh - gear.B_m * x[2] - rub) / gear.J_m
        load = (-spring - gear.sigma * mesh - gear.B_l * x[3] - gear.F_cl) / gear.J_l
        return [x[2], x[3], motor, load]

    found = solve_ivp(rate, (0.0, float(times[-1])), start, "DOP853", t_eval=times, rtol=1e-12, atol=1e-14)
    return np.asarray(found.y)


def start_of(wave: Waveform) -> tuple[float, float, float, float]:
    return 0.0, -float(wave.kinematic_error[0]), float(wave.omega_m[0]), float(wave.omega_l[0])


def at_angle(curve: Array, theta: Array) -> Array:
    """A periodic curve between its points, exactly."""
    c = np.fft.rfft(curve) / curve.size
    n = np.arange(1, c.size)
    return np.asarray(c[0].real + 2 * np.real(np.exp(1j * np.multiply.outer(theta, n)) @ c[1:]))


@pytest.mark.slow
@pytest.mark.parametrize("rpm", [120, 300, 500])
def test_the_steady_state_is_where_dop853_stays(gear: Gear, rpm: int) -> None:
    wave = at_speed(gear, rpm * RPM)
    times = np.linspace(0.0, 0.3, 301)
    y = dop853(gear, start_of(wave), times, wave.tau)
    error = y[0] / gear.ratio - y[1]
    assert np.max(np.abs(at_angle(wave.kinematic_error, y[0]) - error)) < 1e-12  # rad, of 3e-4


@pytest.mark.parametrize("rpm", [120, 300, 500])
def test_at_constant_torque_the_rig_shows_the_figures_of_the_physics_notes(gear: Gear, rpm: int) -> None:
    wave = at_speed(gear, rpm * RPM)
    c = np.abs(wave.orders(wave.kinematic_error, 4)) * DEG
    swings = [float(np.ptp(curve)) * DEG for curve in (wave.kinematic_error, wave.flexible)]
    found = (*swings, float(c[1]), float(c[3]), float(np.ptp(wave.spring_torque)))
    assert found == pytest.approx(TABLE[rpm], rel=0.02)  # they give two or three digits


@pytest.mark.parametrize("rpm", [120, 300, 480])
def test_a_small_error_without_friction_obeys_the_transmissibility(gear: Gear, rpm: int) -> None:
    c = gear.kinematic_error
    small = FourierSeries(tuple(1e-4 * a for a in c.a), tuple(1e-4 * b for b in c.b))
    bare = replace(gear, kinematic_error=small, tau_c=0.0, tau_s=0.0, F_cl=0.0, B_m=1e-5, B_l=0.0, B_ml=0.0)
    wave = at_speed(bare, rpm * RPM)
    ratio = np.conj(wave.orders(wave.kinematic_error, 15) / wave.orders(wave.pure, 15))
    assert ratio == pytest.approx(transmissibility(bare, np.arange(1.0, 16.0), rpm * RPM), rel=2e-3)


def test_turned_backward_the_mirrored_gear_does_the_same(gear: Gear) -> None:
    c = gear.kinematic_error
    mirrored = replace(gear, kinematic_error=FourierSeries(tuple(-a for a in c.a), c.b))
    forward, backward = at_speed(gear, 300 * RPM), at_speed(mirrored, -300 * RPM)
    assert backward.tau == pytest.approx(-forward.tau, rel=1e-9)
    assert np.ptp(backward.kinematic_error) == pytest.approx(np.ptp(forward.kinematic_error), rel=1e-9)


def test_torque_and_speed_are_two_ways_to_the_same_state(gear: Gear) -> None:
    tau = torque_for(gear, 300 * RPM)
    wave = steady_state(gear, tau)
    assert wave.mean_speed == pytest.approx(300 * RPM, rel=1e-9)
    assert wave.time[-1] * 300 / 60 == pytest.approx(1.0, abs=0.02)
    assert np.all(np.diff(wave.time) > 0)


def test_a_load_shifts_the_mean_by_its_torque_over_the_stiffness(gear: Gear) -> None:
    free, loaded = at_speed(gear, 60 * RPM), at_speed(gear, 60 * RPM, tau_ext=-10.0)
    shift = float(np.mean(loaded.kinematic_error) - np.mean(free.kinematic_error))
    assert shift == pytest.approx(10.0 / gear.K, rel=1e-3)
    assert loaded.tau - free.tau == pytest.approx(10.0 / gear.ratio, rel=0.01)


def test_less_torque_than_friction_is_refused_with_both_numbers(gear: Gear) -> None:
    with pytest.raises(NoSteadyState, match=r"0\.2 N·m .* takes 0\.32 N·m"):
        steady_state(gear, 0.2)


def test_above_resonance_the_load_no_longer_follows(gear: Gear) -> None:
    light = replace(gear, B_sp=0.5)
    wave = at_speed(light, 3000 * RPM)
    assert np.ptp(wave.kinematic_error) < 0.3 * np.ptp(wave.pure)


@pytest.mark.slow
def test_the_march_keeps_within_a_billionth_of_dop853_and_its_energy_adds_up(gear: Gear) -> None:
    wave = at_speed(gear, 300 * RPM)
    times = np.linspace(0.0, 0.3, 301)
    begin = start_of(wave)
    y = dop853(gear, begin, times, wave.tau + 0.1)
    motion = under_torque(
        gear, times, np.full(times.size, wave.tau + 0.1), start=Start(begin[0], begin[2], begin[1], begin[3])
    )
    off = (motion.theta_m / gear.ratio - motion.theta_l) - (y[0] / gear.ratio - y[1])
    assert np.max(np.abs(off)) < 1e-9
    residual = motion.stored - motion.stored[0] + motion.lost - motion.work
    assert np.max(np.abs(residual)) < 1e-7 * motion.work[-1]


def test_the_march_is_of_second_order(gear: Gear) -> None:
    wave, times = at_speed(gear, 300 * RPM), np.linspace(0.0, 0.1, 11)
    theta_m, theta_l, omega_m, omega_l = start_of(wave)
    y = dop853(gear, (theta_m, theta_l, omega_m, omega_l), times, wave.tau)
    error = []
    for step in (8e-5, 4e-5):
        start = Start(theta_m, omega_m, theta_l, omega_l)
        motion = under_torque(gear, times, np.full(11, wave.tau), start=start, step=step)
        error.append(np.max(np.abs(motion.theta_l - y[1])))
    assert error[0] / error[1] == pytest.approx(4.0, rel=0.1)


def test_under_less_than_breakaway_nothing_moves_and_past_it_it_does(gear: Gear) -> None:
    t = np.linspace(0.0, 1.0, 101)
    held = under_torque(gear, t, np.full(101, 0.49))
    assert np.all(held.theta_m == 0.0)
    assert under_torque(gear, t, np.full(101, 0.51)).theta_m[-1] > 1.0


def test_without_torque_friction_brings_it_to_rest_and_keeps_it(gear: Gear) -> None:
    t = np.linspace(0.0, 2.0, 401)
    motion = under_torque(gear, t, np.zeros(401), start=Start(omega_m=50.0))
    assert motion.omega_m[-1] == 0.0
    assert motion.omega_l[-1] == 0.0
    assert motion.lost[-1] == pytest.approx(motion.stored[0] - motion.stored[-1], rel=1e-3)


@pytest.mark.slow
def test_the_load_under_a_known_motion_goes_where_both_together_went(gear: Gear) -> None:
    wave = at_speed(gear, 300 * RPM)
    t = np.arange(0.0, 2.5, 1e-3)
    free = under_torque(gear, t, np.full(t.size, wave.tau), start=Start(0.0, wave.omega_m[0], -wave.kinematic_error[0]))
    driven = under_motion(gear, t, free.theta_m, theta_l=float(free.theta_l[0]))
    assert np.max(np.abs(driven - free.theta_l)[-500:]) < 2e-8  # rad: the spline between rows; beginnings die out


def test_a_load_that_friction_holds_stays_until_the_spring_is_wound_up(gear: Gear) -> None:
    t = np.arange(0.0, 1.0, 1e-3)
    heavy = replace(gear, F_cl=5.0, kinematic_error=FourierSeries((0.0,), (0.0,)))
    theta_m = 0.1 * t  # winds by 2e-3·t rad: 5 N·m after 0.35 s
    theta_l = under_motion(heavy, t, theta_m)
    assert np.ptp(theta_l[:300]) < 1e-7  # it begins with the speed of the motor's share, and stops
    assert theta_l[-1] > theta_l[0]


@pytest.mark.slow
@pytest.mark.parametrize("rpm", [120, 300, 500])
def test_the_twin_at_the_same_constant_torque_shows_the_same_waveform(gear: Gear, rpm: int) -> None:
    """Plant and simulator share the equations and not a line of code."""
    from sim.plant import Plant

    parameters = replace(twin_parameters(read("twin").file), friction_noise=0.0)
    plant, wave = Plant(parameters), at_speed(gear, rpm * RPM)
    plant.place(0.0, wave.mean_speed)
    rows = []
    for k in range(7000):  # 7 s: the beginning dies out with 0.4 s
        plant.advance(1e-3, wave.tau)
        if k >= 5000:
            x = plant.truth()
            rows.append((x.theta_m, x.theta_m / gear.ratio - x.theta_l, x.omega_m, -x.phi))
    theta, error, omega, bending = np.array(rows).T
    assert np.max(np.abs(at_angle(wave.kinematic_error, theta) - error)) < 2e-7  # rad, of 4e-4 and more
    assert np.max(np.abs(at_angle(wave.flexible, theta) - bending)) < 2e-7
    assert np.max(np.abs(at_angle(wave.omega_m, theta) - omega)) < 2e-3 * np.ptp(wave.omega_m)
