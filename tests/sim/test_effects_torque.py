"""Friction, motor and load beyond the paper's model: each by what an experiment would see of it."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from sim import kernel
from sim.effects import Effects, ErrorLines, Friction, Load, Motor, lines
from sim.parameters import TwinParameters
from sim.plant import Plant
from sim.vector import bristles
from tests.sim.conftest import FRICTIONLESS, with_gear

TICK = 1e-3  # s


def having(parameters: TwinParameters, **sections: Any) -> TwinParameters:
    return dataclasses.replace(parameters, effects=Effects(**sections))


def torque_at(parameters: TwinParameters, omega: float, load: float = 0.0, seconds: float = 8.0) -> float:
    """Mean motor torque [N·m] that keeps `omega` rad/s against `load` N·m, over the last whole turns."""
    plant, rows = Plant(parameters), []
    plant.place(0.0, omega)
    plant.tau_ext, integral = -load, load / parameters.gear.ratio
    for _ in range(round(seconds / TICK)):
        miss = omega - plant.motor[1]
        integral += 0.3 * miss * TICK
        plant.advance(TICK, 0.1 * miss + integral)
        rows.append((plant.truth().theta_m, plant.truth().tau_m))
    theta, tau = np.array(rows).T
    turns = math.floor((theta[-1] - theta[len(theta) // 2]) / (2 * math.pi))
    return float(np.mean(tau[theta > theta[-1] - 2 * math.pi * turns]))


@pytest.mark.slow
def test_friction_grows_with_the_torque_that_is_driven_and_with_that_which_drives(calm: TwinParameters) -> None:
    rubbing = having(with_gear(calm, F_cl=0.0), friction=Friction(by_load=0.25))
    none = torque_at(rubbing, 6.3)
    for load in (10.0, -10.0):
        more = torque_at(rubbing, 6.3, load) - none
        assert more == pytest.approx(load / 50 + 0.25 * 10.0 / 50, abs=2e-3)
    against = torque_at(calm, 6.3, 10.0) - torque_at(calm, 6.3)
    assert against == pytest.approx(10.0 / 50, abs=1e-3)  # the paper's model: no more than the load's own share


@pytest.mark.slow
def test_drag_has_its_power_of_speed(calm: TwinParameters) -> None:
    for friction, law in (
        (Friction(quadratic_drag=1e-4), lambda w: 1e-4 * w**2),
        (Friction(two_thirds_drag=0.01), lambda w: 0.01 * w ** (2 / 3)),
    ):
        for omega in (10.0, 30.0):
            more = torque_at(having(calm, friction=friction), omega) - torque_at(calm, omega)
            assert more == pytest.approx(law(omega), rel=0.01)


def bristling(calm: TwinParameters) -> tuple[TwinParameters, np.ndarray, np.ndarray]:
    """A motor whose Coulomb friction is all bristles, well damped and free of its gear; their k_i and s_i."""
    law = Friction(presliding=0.3, presliding_deg=0.1)
    free = with_gear(calm, K=1e-3, B_sp=0.0, B_ml=0.0, B_m=2.0, tau_s=0.3)
    pairs = np.array(bristles(law))
    return having(free, friction=law), pairs[::2], pairs[1::2]


def test_before_it_slides_friction_gives_way_and_springs_back_in_part(calm: TwinParameters) -> None:
    parameters, k, s = bristling(calm)
    plant = Plant(parameters)

    def settle(tau: float) -> float:
        for _ in range(3000):
            plant.advance(TICK, tau)
        return plant.truth().theta_m

    def torque(x: float) -> float:
        return float(np.sum(k * np.minimum(x, s)))

    at_250 = settle(0.25)
    assert torque(at_250) == pytest.approx(0.25, rel=1e-3)
    assert 0.0 < at_250 < s.max()
    back = settle(0.0)
    unloading = float(np.sum(k * (np.minimum(at_250, s) - np.minimum(at_250 - back, 2 * s))))
    assert unloading == pytest.approx(0.0, abs=2e-4)  # Masing: the way back is the way out, twice as wide
    assert 0.1 * at_250 < back < 0.9 * at_250
    again = settle(0.25)
    assert again == pytest.approx(at_250, rel=1e-3)  # the small loop closes


@pytest.mark.slow
def test_sliding_bristles_are_coulomb_friction(calm: TwinParameters) -> None:
    law = Friction(presliding=calm.gear.tau_c)
    for omega in (6.3, -6.3):
        expected = torque_at(calm, omega)
        assert torque_at(having(calm, friction=law), omega) == pytest.approx(expected, rel=2e-3)


def test_friction_by_angle_shows_at_standstill_where_it_holds_most(calm: TwinParameters) -> None:
    uneven = having(calm, friction=Friction(by_angle=0.2, by_angle_deg=40.0))
    for theta in (0.2, 1.0, 2.0, 3.0):
        plant, tau = Plant(uneven), 0.0
        plant.place(theta)
        while plant.motor[1] == 0.0:
            tau += 1e-3
            plant.advance(0.01, tau)
        expected = calm.gear.tau_s * (1 + 0.2 * math.cos(2 * theta - math.radians(40.0)))
        assert tau == pytest.approx(expected, abs=2e-3)


@pytest.mark.slow
def test_friction_falls_as_the_drive_warms_and_comes_back(calm: TwinParameters) -> None:
    law = Friction(thermal_beta=0.03, thermal_rise=4.0, thermal_time=2.0)
    plant = Plant(having(calm, friction=law))
    plant.place(0.0, 30.0)
    for _ in range(12000):
        plant.advance(TICK, 0.5 + 0.2 * (30.0 - plant.motor[1]))
    gear, warmth = calm.gear, float(plant.state[kernel.WARMTH])
    factor, omega = math.exp(-0.03 * warmth), plant.motor[1]
    slip = omega * (1 + gear.sigma / gear.ratio)
    power = factor * (gear.tau_c * omega + gear.B_m * omega**2 + gear.B_ml * slip**2)
    assert warmth == pytest.approx(4.0 * power, rel=0.01)  # R·P
    assert 0.3 < factor < 0.9
    assert torque_at(having(calm, friction=law), 30.0, seconds=14.0) < 0.9 * torque_at(calm, 30.0)
    plant.place(0.0)
    assert plant.state[kernel.WARMTH] == 0.0


@pytest.mark.slow
def test_cogging_moves_the_free_motor_and_holds_it_at_its_notches(calm: TwinParameters) -> None:
    loose = with_gear(calm, K=1e-3, B_sp=0.0, B_ml=0.0, B_m=2e-3, **FRICTIONLESS)
    plant = Plant(having(loose, motor=Motor(cogging=0.05, cogging_order=24.0, cogging_phase_deg=30.0)))
    for start in (0.1, 0.7, 1.9):
        plant.place(start)
        for _ in range(20000):
            plant.advance(TICK, 0.0)
        angle = 24.0 * plant.truth().theta_m - math.radians(30.0)
        assert math.cos(angle) == pytest.approx(0.0, abs=1e-3)
        assert math.sin(angle) > 0.9  # −A·sin/n is least


def test_ripple_is_in_proportion_to_the_torque_asked(calm: TwinParameters) -> None:
    motor = Motor(ripple=0.03, ripple_order=8.0, ripple_phase_deg=20.0)
    rippling, free = having(with_gear(calm, **FRICTIONLESS), motor=motor), with_gear(calm, **FRICTIONLESS)
    for theta in (0.0, 0.3, 0.9):
        for tau in (0.0, 0.5, -2.0):
            gained = []
            for parameters in (rippling, free):
                plant = Plant(parameters)
                plant.place(theta)
                plant.state[kernel.TAU_M] = tau
                plant.advance(0.0, tau)
                gained.append(plant.motor[2] * calm.gear.J_m)
            expected = 0.03 * tau * math.cos(8 * theta - math.radians(20.0))
            assert gained[0] - gained[1] == pytest.approx(expected, abs=1e-12)


def test_an_unbalanced_load_hangs_down(calm: TwinParameters) -> None:
    heavy = having(with_gear(calm, F_cl=0.0, tau_s=9.0, tau_c=9.0), load=Load(unbalance=3.0, unbalance_phase_deg=90.0))
    plant = Plant(heavy)
    plant.place(0.0)  # a quarter turn from its lowest place
    for _ in range(6000):
        plant.advance(TICK, 0.0)
    assert plant.truth().tau_l == pytest.approx(-3.0, rel=1e-4)  # the gear holds it back, it pulls forward


def test_vibration_keeps_its_frequency_whatever_the_speed(calm: TwinParameters) -> None:
    shaken = having(with_gear(calm, **FRICTIONLESS), load=Load(vibration=0.5, vibration_hz=50.0))
    peaks = []
    for omega in (5.0, 12.0):
        plant, tau = Plant(shaken), []
        plant.place(0.0, omega)
        for k in range(6000):
            plant.advance(TICK, 0.1 * (omega - plant.motor[1]))
            if k >= 2000:
                tau.append(plant.truth().tau_l)
        spectrum = np.abs(np.fft.rfft(np.array(tau) * np.hanning(len(tau))))
        freq = np.fft.rfftfreq(len(tau), TICK)
        peaks.append(freq[40:][np.argmax(spectrum[40:])])  # above 10 Hz
    assert peaks == pytest.approx([50.0, 50.0], abs=0.3)


@pytest.mark.parametrize("sigma", [0, 1])
def test_lines_beside_the_series_lie_where_the_gears_frames_put_them(calm: TwinParameters, sigma: int) -> None:
    e = ErrorLines(flexspline_deg=0.003, flexspline_second_deg=0.001, tooth_mesh_deg=0.0003, output_deg=0.004)
    orders = [order for order, _, _ in lines(e, 50.0, sigma)]
    assert orders == pytest.approx([2.04, 4.08, 102.0, 0.02] if sigma == 1 else [1.96, 3.92, 100.0, 0.02])
    plant = Plant(having(with_gear(calm, sigma=sigma), error_lines=e))
    theta = np.linspace(0.0, 2 * math.pi * 50, 8000)
    error = np.array([kernel.kinematic_error(x, 0.0, plant.vector)[0] for x in theta])
    error -= calm.gear.kinematic_error.value(theta)
    columns = np.array([f(order * theta) for order in orders for f in (np.cos, np.sin)]).T
    fit = np.linalg.lstsq(columns, error, rcond=None)[0].reshape(-1, 2)
    np.testing.assert_allclose(np.degrees(np.hypot(*fit.T)), [0.003, 0.001, 0.0003, 0.004], rtol=1e-6)
    step = 1e-6
    for x in (0.4, 3.0, 77.0):
        near = [kernel.kinematic_error(x + s * step, 0.0, plant.vector)[0] for s in (-1, 1)]
        assert kernel.kinematic_error(x, 0.0, plant.vector)[1] == pytest.approx(
            (near[1] - near[0]) / (2 * step), rel=1e-4
        )
