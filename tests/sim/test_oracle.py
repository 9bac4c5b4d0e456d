"""The plant against closed forms: the torsional mode's transmissibility, the linear rig, locks and dead weights."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt
import pytest

from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.linear import transmissibility
from sim.parameters import TwinParameters
from sim.plant import Plant
from tests.sim.conftest import FRICTIONLESS, with_gear

DEG = np.pi / 180
TICK = 1e-3  # s
ORDERS = np.arange(1, 16)
SMALL = 1e-9  # rad, every order of the error: so small that orders no longer mix, N·θ̃_p′ < 1e-6
NO_DRAG = {"B_m": 0.0, "B_l": 0.0, "B_ml": 0.0}
Complex = npt.NDArray[np.complex128]


def small_error(phases: npt.NDArray[np.float64]) -> FourierSeries:
    return FourierSeries.from_polar(np.full(15, SMALL), phases)


def run_at(parameters: TwinParameters, omega: float, tau: float, settle: float, turns: int) -> npt.NDArray[np.float64]:
    """Rows (θ_m, ω_m, θ_l, φ, τ_l), one a tick, over `turns` motor turns at about `omega` rad/s, after `settle` s."""
    plant = Plant(parameters)
    plant.place(0.3, omega)
    for _ in range(round(settle / TICK)):
        plant.advance(TICK, tau)
    rows = []
    for _ in range(int(turns * 2 * np.pi / omega / TICK) + 1):
        x = plant.truth()
        rows.append((x.theta_m, x.omega_m, x.theta_l, x.phi, x.tau_l))
        plant.advance(TICK, tau)
    return np.array(rows)


def harmonics(theta_m: npt.NDArray[np.float64], error: npt.NDArray[np.float64]) -> Complex:
    """c_n of error = c_0 + Re Σ c_n e^{−jnθ}, orders 0..15, by least squares beside a slow drift."""
    angle = np.multiply.outer(theta_m, ORDERS)
    drift = np.stack([np.ones_like(theta_m), theta_m - theta_m.mean()], axis=1)
    fit = np.linalg.lstsq(np.hstack([drift, np.cos(angle), np.sin(angle)]), error, rcond=None)[0]
    return np.concatenate([[fit[0]], fit[2:17] + 1j * fit[17:]])


@pytest.mark.parametrize("rpm", [120.0, 300.0, 500.0])
def test_every_order_meets_the_transmissibility_of_the_torsional_mode(calm: TwinParameters, rpm: float) -> None:
    # the closed form knows one damper, B_sp: drag and friction are off, and the rig coasts at zero torque
    phases = np.linspace(-2.0, 2.5, 15)
    quiet = with_gear(calm, kinematic_error=small_error(phases), **NO_DRAG, **FRICTIONLESS)
    rows = run_at(quiet, rpm * np.pi / 30, tau=0.0, settle=3.0, turns=20)
    omega = (rows[-1, 0] - rows[0, 0]) / (TICK * (len(rows) - 1))
    measured = harmonics(rows[:, 0], rows[:, 0] / calm.gear.ratio - rows[:, 2])[1:] / (SMALL * np.exp(1j * phases))
    expected = transmissibility(quiet.gear, ORDERS.astype(float), omega)
    np.testing.assert_allclose(np.abs(measured), np.abs(expected), rtol=1e-3)
    # phases as well: with e^{−jnθ} in place of e^{+jnθ} a lag turns the other way
    assert np.max(np.abs(np.angle(measured / np.conj(expected)))) < 1e-3


def linear_rig(gear: Gear, omega: float) -> Complex:
    """θ̃_n/θ̃_p,n of equations 6-7 linearised about steady turning, every viscous term on, shape (15,).

    Drag of the load winds the spring to the mean torque S, and S·θ̃_p′ is a torque on the motor of first order too.
    """
    mean = -(gear.B_l / gear.ratio + gear.sigma * gear.B_ml * (1 + gear.sigma / gear.ratio)) * omega
    found = []
    for n, s in zip(ORDERS, 1j * ORDERS * omega, strict=True):
        lever = np.array([-1.0 / gear.ratio, 1.0])
        slip = np.array([1.0, gear.sigma])
        spring = gear.K + gear.B_sp * s
        stiff = np.outer(lever, lever) * spring + np.outer(slip, slip) * gear.B_ml * s
        mass = np.diag([gear.J_m * s**2 + gear.B_m * s, gear.J_l * s**2 + gear.B_l * s])
        x = np.linalg.solve(mass + stiff, -lever * spring - np.array([1j * n * mean, 0.0]))  # moved by θ̃_p = 1
        found.append(-lever @ x)
    return np.array(found)


def test_with_every_viscous_term_the_linear_rig_is_met(calm: TwinParameters) -> None:
    phases = np.linspace(-1.0, 1.0, 15)
    gear = dataclasses.replace(calm.gear, kinematic_error=small_error(phases), **FRICTIONLESS)
    omega = 500.0 * np.pi / 30
    drag = gear.B_m + gear.B_ml * (1 + gear.sigma / gear.ratio) ** 2 + gear.B_l / gear.ratio**2
    rows = run_at(dataclasses.replace(calm, gear=gear), omega, tau=drag * omega, settle=6.0, turns=20)
    omega = (rows[-1, 0] - rows[0, 0]) / (TICK * (len(rows) - 1))
    measured = harmonics(rows[:, 0], rows[:, 0] / gear.ratio - rows[:, 2])[1:] / (SMALL * np.exp(1j * phases))
    np.testing.assert_allclose(np.abs(measured), np.abs(linear_rig(gear, omega)), rtol=1e-4)


# Independent simulation of the same rig with constant Coulomb friction of 0.30 N·m at the motor, none at the load: mean
# rpm, τ_m N·m, error p-p °, θ̃_s p-p °, C_2 °, C_4 °, motor speed ripple p-p rpm, spring torque p-p N·m, mean error °
TABLE = [
    (60.0, 0.321, 0.0263, 0.0007, 0.01107, 0.00267, 0.41, 0.08, 0.0006),
    (120.0, 0.341, 0.0315, 0.0069, 0.01128, 0.00289, 1.6, 0.87, 0.0013),
    (300.0, 0.404, 0.0413, 0.0233, 0.01306, 0.00696, 3.6, 2.9, 0.0031),
    (400.0, 0.438, 0.0579, 0.0444, 0.01534, 0.01693, 6.1, 5.5, 0.0042),
    (500.0, 0.473, 0.0526, 0.0366, 0.01955, 0.00338, 5.1, 4.6, 0.0054),
    (742.57, 0.559, 0.240, 0.229, 0.119, 0.0016, 32.0, 28.6, 0.0077),  # order 2 in resonance: below the 750 asked for
]


@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row[0]:g}rpm")
def test_behaviour_at_speed_is_that_of_an_independent_simulation(calm: TwinParameters, row: tuple[float, ...]) -> None:
    rpm, tau, total, flexible, c2, c4, ripple, spring, mean = row
    gear = dataclasses.replace(calm.gear, tau_s=0.3, tau_c=0.3, F_cl=0.0)
    asked = 750.0 if rpm > 700 else rpm
    drag = gear.B_m + gear.B_ml * (1 + 1 / gear.ratio) ** 2 + gear.B_l / gear.ratio**2
    torque = 0.3 + drag * asked * np.pi / 30
    assert torque == pytest.approx(tau, abs=1e-3)
    rows = run_at(dataclasses.replace(calm, gear=gear), asked * np.pi / 30, torque, settle=5.0, turns=10)
    error = rows[:, 0] / gear.ratio - rows[:, 2]
    c = harmonics(rows[:, 0], error)
    assert np.mean(rows[:, 1]) * 30 / np.pi == pytest.approx(rpm, rel=2e-3)
    assert np.ptp(error) / DEG == pytest.approx(total, rel=0.01)
    assert np.ptp(rows[:, 3]) / DEG == pytest.approx(flexible, rel=0.01, abs=1e-4)
    assert abs(c[2]) / DEG == pytest.approx(c2, rel=0.01)
    assert abs(c[4]) / DEG == pytest.approx(c4, rel=0.01, abs=1e-4)
    assert np.ptp(rows[:, 1]) * 30 / np.pi == pytest.approx(ripple, rel=0.04)
    assert gear.K * np.ptp(rows[:, 3]) == pytest.approx(spring, rel=0.02, abs=0.01)
    assert c[0].real / DEG == pytest.approx(mean, rel=0.05, abs=1e-4)


@pytest.mark.slow
def test_locked_output_winds_up_with_the_stiffness(calm: TwinParameters) -> None:
    plant = Plant(calm)
    plant.locked = True
    rows = []
    for k in range(12000):
        plant.advance(TICK, 0.8 * np.sin(2 * np.pi * k * TICK / 6.0))
        x = plant.truth()
        error = float(calm.gear.kinematic_error.value(np.array(x.theta_m)))
        rows.append((x.theta_m / calm.gear.ratio - error - x.theta_l, x.tau_l, x.omega_m))
        assert x.omega_l == 0.0
    wind_up, tau_l, omega_m = np.array(rows).T
    rest = omega_m == 0.0  # viscous parts leave the torque
    assert np.ptp(tau_l[rest]) > 20.0
    assert np.polyfit(wind_up[rest], tau_l[rest], 1)[0] == pytest.approx(calm.gear.K, rel=1e-9)
    assert np.ptp(plant.truth().theta_l - rows[0][0]) < 1.0


def test_a_dead_weight_winds_the_spring_by_torque_over_stiffness(calm: TwinParameters) -> None:
    plant = Plant(with_gear(calm, F_cl=0.0, tau_s=1.0, tau_c=1.0))
    plant.tau_ext = -7.5  # hangs against forward motion; the motor's friction holds 50 N·m at the output
    for _ in range(5000):
        plant.advance(TICK, 0.0)
    x = plant.truth()
    assert x.omega_m == 0.0
    assert x.phi == pytest.approx(-7.5 / calm.gear.K, rel=1e-6)
    assert x.tau_l == pytest.approx(7.5, rel=1e-6)  # the gear pushes forward against it


def test_forward_and_reverse_differ_by_the_load_friction_over_stiffness(calm: TwinParameters) -> None:
    mean = []
    for sign in (1.0, -1.0):
        plant = Plant(calm)
        plant.place(0.0, sign * 1.005)
        errors = []
        for k in range(14000):
            plant.advance(TICK, sign * 0.3233 + 0.1 * (sign * 1.005 - plant.motor[1]))
            x = plant.truth()
            if k > 14000 - round(2 * np.pi / 1.005 / TICK):
                errors.append(x.theta_m / calm.gear.ratio - x.theta_l)
        mean.append(np.mean(errors) / DEG)
    assert mean[0] - mean[1] == pytest.approx(2 * calm.gear.F_cl / calm.gear.K / DEG, rel=0.02)  # ±0.008°
