"""Forms that effects of the library take beside their textbook ones, against the same thing worked out another way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

from rig.model.effect import Array, Fit, Port
from rig.model.effects.lost_motion import BY_ANGLE, LostMotion
from rig.model.effects.presliding_friction import BRISTLES, EACH_WAY, ELEMENTS, MOTOR, PreslidingFriction
from rig.model.effects.stribeck_friction import StribeckFriction
from rig.model.effects.thermal_friction_drift import ThermalFrictionDrift
from rig.model.effects.torque_ripple import TorqueRipple
from rig.model.effects.torsional_mode import DRIVEN, FLANGE, TorsionalMode
from rig.model.memory import presliding
from tests.contract.test_effects import KNOWN, N, motion


def left(columns: Array, wanted: Array) -> float:
    """Of `wanted` (n,), what columns (n, k) fitted to it leave."""
    c = np.linalg.lstsq(columns, wanted, rcond=None)[0]
    return float(np.std(wanted - columns @ c) / np.std(wanted))


def test_elements_take_a_curve_that_no_bristle_takes() -> None:
    """From rest, friction that builds up as x/(s + |x|); the same at twice the size after the motor turned back."""
    t = 1e-3 * np.arange(6000)
    theta = 2.0 * (1.0 - np.cos(np.pi * t / 3.0))  # to 4 rad and back
    way = np.sign(np.gradient(theta, 1e-3))
    back = theta.max() - theta
    friction = np.where(t < 3.0, theta / (0.2 + theta), 4.0 / 4.2 - 2 * (back / 2) / (0.2 + back / 2))
    s = dataclasses.replace(motion(n=t.size), t=t, theta_m=theta, omega_m=np.gradient(theta, 1e-3), way=way)
    effect, slid = PreslidingFriction(), way[:, None]
    elements = effect.columns(s, (MOTOR, 0.3, ELEMENTS))[Port.MOTOR_TORQUE]
    bristles = [effect.columns(s, (MOTOR, x, 0.0))[Port.MOTOR_TORQUE] for x in (0.1, 0.2, 0.4, 0.8)]
    assert left(np.hstack([elements, slid]), friction) < 0.04
    assert min(left(np.hstack([bristle, slid]), friction) for bristle in bristles) > 0.05


def test_bristles_take_a_friction_that_approaches_what_it_will_be_with_a_long_tail() -> None:
    """From where the last reversal left it: after 50 times the way a fiftieth is still to come."""
    t = 1e-3 * np.arange(6000)
    theta = 2.0 * (1.0 - np.cos(np.pi * t / 3.0))  # to 4 rad and back
    way = np.sign(np.gradient(theta, 1e-3))
    since = np.where(t < 3.0, theta, theta.max() - theta)
    friction = way * (1.0 - np.where(t < 3.0, 1.0, 2.0) / (1.0 + since / 0.08))
    s = dataclasses.replace(motion(n=t.size), t=t, theta_m=theta, omega_m=np.gradient(theta, 1e-3), way=way)
    effect, slid = PreslidingFriction(), way[:, None]
    several = effect.columns(s, (MOTOR, 0.15, BRISTLES))[Port.MOTOR_TORQUE]
    bristles = [effect.columns(s, (MOTOR, x, 0.0))[Port.MOTOR_TORQUE] for x in (0.05, 0.1, 0.2, 0.4, 0.8)]
    assert left(np.hstack([several, slid]), friction) < 0.03
    assert min(left(np.hstack([bristle, slid]), friction) for bristle in bristles) > 0.06


def test_bristles_may_be_others_forward_than_backward() -> None:
    """A friction that builds up over 0.05 rad forward and over 0.4 rad backward: no curve is both."""
    t = 1e-3 * np.arange(12000)
    theta = 2.0 * (1.0 - np.cos(np.pi * t / 3.0))  # to 4 rad and back, twice
    way = np.sign(np.gradient(theta, 1e-3))
    first, second = (presliding(theta, x, 0.0) for x in (0.05, 0.4))
    friction = np.where(way > 0, first, second)
    s = dataclasses.replace(motion(n=t.size), t=t, theta_m=theta, omega_m=np.gradient(theta, 1e-3), way=way)
    later, slid = t > 3.0, way[:, None]
    made = [PreslidingFriction().columns(s, (MOTOR, 0.1, law))[Port.MOTOR_TORQUE] for law in (EACH_WAY, BRISTLES)]
    each, one = (left(np.hstack([x, slid])[later], friction[later]) for x in made)
    assert each < 0.05
    assert one > 0.15


@pytest.mark.parametrize("law", [BRISTLES, EACH_WAY])
def test_of_bristles_what_they_build_up_together_is_told_where_that_is_known_better(law: float) -> None:
    """A long one that nobody saw the end of spoils what all of them lose, and hardly their sum."""
    ways = 2 if law == EACH_WAY else 1
    c = np.tile([0.05, 0.03, 0.0, 0.0], ways)
    unsure = np.zeros((c.size + 3, c.size + 3))
    unsure[c.size - 1, c.size - 1] = 0.004**2
    friction, way = PreslidingFriction().parameters(Fit(c, (MOTOR, 0.1, law), unsure, KNOWN, N))
    assert friction.value == pytest.approx(0.08)
    assert not friction.holds_zero
    assert way.value == pytest.approx(0.1 * (0.05 * 0.3 + 0.03 * 1.0) / 0.08)


def test_of_elements_the_one_is_told_that_loses_as_much_at_a_reversal() -> None:
    fit = Fit(np.array([0.01, 0.02, 0.0, 0.01]), (MOTOR, 0.5, ELEMENTS), np.zeros((7, 7)), KNOWN, N)
    told = {p.name: p.value for p in PreslidingFriction().parameters(fit)}
    lost, longer = 0.01 * 0.2 + 0.02 * 0.6 + 0.01 * 5.4, 0.01 * 0.2**2 + 0.02 * 0.6**2 + 0.01 * 5.4**2
    assert told == pytest.approx({"tau_presliding": lost**2 / longer, "x_0": 0.5 * longer / lost})
    assert told["tau_presliding"] * told["x_0"] == pytest.approx(0.5 * lost)


def test_of_elements_beside_longer_ones_a_short_one_that_nobody_sees_says_nothing() -> None:
    """One of 0.02 rad of which 1 N·m more or less is not seen leaves what all of them lose as well known as it was."""
    unsure = np.zeros((7, 7))
    unsure[0, 0] = 1.0
    fit = Fit(np.array([0.0, 0.02, 0.02, 0.01]), (MOTOR, 0.1, ELEMENTS), 1e-4 * unsure, KNOWN, N)
    friction, way = PreslidingFriction().parameters(fit)
    assert not friction.holds_zero
    assert way.ci95[1] - way.value < 0.1 * way.value


def test_a_ripple_may_saturate_alike_whichever_way_the_torque_points() -> None:
    """r·cos(6·θ_m)·τ/(1 + |τ|/0.8), to 1.2 N·m; a field that the torque turns takes one way more and the other less."""
    t = 1e-3 * np.arange(6000)
    torque = 1.2 * np.sin(np.pi * t / 1.5)
    s = dataclasses.replace(motion(n=t.size), t=t, theta_m=7.0 * t, omega_m=np.full(t.size, 7.0), tau_m=torque)
    ripple = np.cos(42.0 * t + 0.4) * torque / (1.0 + np.abs(torque) / 0.8)
    effect = TorqueRipple()
    of = {law: effect.columns(s, (6.0, law))[Port.MOTOR_TORQUE] for law in (effect.REACTING, effect.SATURATING)}
    assert left(of[effect.SATURATING], ripple) < 0.05
    assert left(of[effect.REACTING], ripple) > 0.12
    fit = Fit(np.array([0.01, 0.0, -0.004, 0.0]), (6.0, effect.SATURATING), np.zeros((6, 6)), KNOWN, N)
    assert [p.name for p in effect.parameters(fit)][2] == "order_6_saturating_amplitude"


@pytest.mark.parametrize("fall", [0.15, 0.25, 0.6])
def test_the_time_constant_of_a_warm_up_holds_for_an_oil_as_well(fall: float) -> None:
    """F·exp(−a·(1 − exp(−t/820 s))) in half an hour, fitted with τ_c + τ_1·exp(−t/t_w): t_w comes out short."""
    t = np.linspace(0.0, 2000.0, 400)
    friction = 0.13 * np.exp(-fall * -np.expm1(-t / 820.0))
    found = least_squares(
        lambda x: x[0] + x[1] * np.exp(-t / x[2]) - friction, [0.1, 0.02, 700.0], x_scale=[0.1, 0.01, 500.0]
    ).x
    assert found[2] < (1.0 - 0.3 * fall) * 820.0
    fit = Fit(np.array([found[1], 0.0]), (found[2], 0.0, 1e-3), np.zeros((5, 5)), KNOWN, N, tau_c=found[0] + found[1])
    told = {p.name: p.ci95 for p in ThermalFrictionDrift().parameters(fit)}
    assert told["t_w"][0] == pytest.approx(found[2])
    assert 820.0 < told["t_w"][1] < 1.1 * 820.0
    assert {p.name: p.ci95[1] for p in ThermalFrictionDrift().parameters(dataclasses.replace(fit, tau_c=None))}[
        "t_w"
    ] == pytest.approx(found[2])


def test_a_gap_may_be_wider_at_one_angle() -> None:
    s = motion()
    gap = 2e-5 * (1 + 0.7 * np.cos(s.theta_m + 0.4)) * np.sign(s.spring_torque)
    far = np.abs(s.spring_torque) > 1.0
    columns = LostMotion().columns(s, (0.1, BY_ANGLE))[Port.WIND_UP]
    assert left(columns[far], gap[far]) < 1e-6
    fit = Fit(np.linalg.lstsq(columns[far], gap[far], rcond=None)[0], (0.1, BY_ANGLE), np.zeros((5, 5)), KNOWN, N)
    told = {p.name: p.value for p in LostMotion().parameters(fit)}
    assert told["gap_by_half_turn_amplitude"] < 1e-9
    at_one = {name: told[name] for name in ("gap", "gap_by_angle_amplitude", "gap_by_angle_phase")}
    assert at_one == pytest.approx({"gap": 4e-5, "gap_by_angle_amplitude": 2.8e-5, "gap_by_angle_phase": 0.4}, rel=1e-3)


def test_a_gap_may_be_wider_every_half_turn() -> None:
    s = motion()
    side, far = np.sign(s.spring_torque), np.abs(s.spring_torque) > 1.0
    columns = LostMotion().columns(s, (0.1, BY_ANGLE))[Port.WIND_UP]
    assert left(columns[far], (side * np.abs(np.cos(s.theta_m + 0.9)))[far]) < 0.13  # order 4 and up are not in it
    assert left(columns[far], (side * (1.0 + np.cos(2 * s.theta_m + 1.8)))[far]) < 1e-6


def test_friction_may_fall_by_more_one_way_than_the_other() -> None:
    effect, shape = StribeckFriction(), (2.0, 1.0, 1.0, 0.0)
    forward, backward = (effect.columns(motion(sign), shape)[Port.MOTOR_TORQUE] for sign in (1.0, -1.0))
    assert forward[:, 0].any()
    assert not forward[:, 1].any()
    np.testing.assert_allclose(backward[:, 1], -forward[:, 0], atol=1e-12)
    fit = Fit(np.array([0.02, 0.009]), shape, np.zeros((5, 5)), KNOWN, N)
    told = {p.name: p.value for p in effect.parameters(fit)}
    assert told["tau_s_minus_tau_c_forward"] == 0.02
    assert told["tau_s_minus_tau_c_backward"] == 0.009
    assert not effect.plausible(dataclasses.replace(fit, coefficients=np.array([0.02, -0.001])))


@pytest.mark.slow
def test_a_disc_on_a_hub_swings_as_the_torque_tells() -> None:
    """Hub and disc of 0.4 and 0.45 kg·m² on a shaft of 4e4 N·m/rad, turned by a torque that sweeps to 60 Hz."""
    hub, disc, k, c = 0.4, 0.45, 4e4, 4.0
    dt = 4e-4
    t = dt * np.arange(20_000)

    def torque(at: float | Array) -> float | Array:
        return 5.0 * np.sin(2 * np.pi * (5.0 + 3.5 * at) * at)

    def rates(at: float, x: Array) -> list[float]:
        through = k * (x[0] - x[1]) + c * (x[2] - x[3])
        return [x[2], x[3], (float(torque(at)) - through) / hub, through / disc]

    x = solve_ivp(rates, (0.0, t[-1]), np.zeros(4), t_eval=t, rtol=1e-8, atol=1e-12).y
    alpha = (torque(t) - k * (x[0] - x[1]) - c * (x[2] - x[3])) / hub
    faster = np.linspace(20.0, 40.0, t.size)  # rad/s: no order of a motor that turns steadily, all of it counts
    s = dataclasses.replace(motion(n=t.size), t=t, dt=dt, omega_m=faster, tau_l=np.asarray(torque(t)), alpha_l=alpha)
    both = float(np.sqrt(k * (hub + disc) / (hub * disc)) / (2 * np.pi))
    zeta = c * (hub + disc) / (hub * disc) / (2 * 2 * np.pi * both)
    shape = (DRIVEN, both, zeta, 0.0)
    column = TorsionalMode().columns(s, shape)[Port.LOAD_TORQUE]
    columns = np.hstack([alpha[:, None], column])
    coefficients = np.linalg.lstsq(columns, s.tau_l, rcond=None)[0]
    assert float(np.std(s.tau_l - columns @ coefficients)) < 0.02 * float(np.std(s.tau_l))
    known = dataclasses.replace(KNOWN, J_l=float(coefficients[0]))
    told = {
        p.name: p.value for p in TorsionalMode().parameters(Fit(coefficients[1:], shape, np.zeros((5, 5)), known, N))
    }
    assert told["J_2"] == pytest.approx(disc, rel=0.02)
    assert told["frequency"] == pytest.approx(np.sqrt(k / disc) / (2 * np.pi), rel=0.01)
    assert told["zeta"] == pytest.approx(c / (2 * np.sqrt(k * disc)), rel=0.02)


@pytest.mark.slow
@pytest.mark.long
def test_a_flange_behind_the_torque_sensor_twists_its_shaft_and_lets_the_load_swing() -> None:
    """Flange and load of 0.08 and 0.9 kg·m² on a shaft of 2e4 N·m/rad, the flange turned by a torque that sweeps."""
    first, load, k, c = 0.08, 0.9, 2e4, 2.0
    dt = 4e-4
    t = dt * np.arange(20_000)

    def torque(at: float | Array) -> float | Array:
        return 5.0 * np.sin(2 * np.pi * (5.0 + 3.5 * at) * at)

    def rates(at: float, x: Array) -> list[float]:
        through = k * (x[0] - x[1]) + c * (x[2] - x[3])
        return [x[2], x[3], (float(torque(at)) - through) / first, through / load]

    x = solve_ivp(rates, (0.0, t[-1]), np.zeros(4), t_eval=t, rtol=1e-8, atol=1e-12).y
    alpha, drives = (k * (x[0] - x[1]) + c * (x[2] - x[3])) / load, np.asarray(torque(t))
    s = dataclasses.replace(
        motion(n=t.size), t=t, dt=dt, omega_m=np.full(t.size, 30.0), torque=drives, tau_l=drives, alpha_l=alpha
    )
    both = float(np.sqrt(k * (first + load) / (first * load)))
    zeta = c * both / (2 * k)
    shape = (FLANGE, both / (2 * np.pi), zeta, 0.0)
    coefficients = np.array([1 / k, first / k, 1 / both**2])
    effect = TorsionalMode()
    got = {port: columns @ coefficients for port, columns in effect.columns(s, shape).items()}
    twist = x[0] - x[1] - drives / k  # beyond what a constant torque does, which the gear's own K has
    assert float(np.std(got[Port.WIND_UP] - twist)) < 0.03 * float(np.std(twist))
    slower = drives - (first + load) * alpha
    assert float(np.std(got[Port.LOAD_TORQUE] - slower)) < 0.02 * float(np.std(slower))
    fit = Fit(coefficients, shape, np.zeros((7, 7)), KNOWN, N)
    assert effect.plausible(fit)
    assert not effect.plausible(dataclasses.replace(fit, coefficients=coefficients * np.array([1.0, 1.0, 9.0])))
    assert {p.name: p.value for p in effect.parameters(fit)} == {
        "shaft_compliance": 1 / k, "frequency": shape[1], "zeta": zeta,
    }  # fmt: skip
