"""What the columns of single effects stand for, beside the same thing worked out another way."""

from __future__ import annotations

import dataclasses
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.search import _same
from rig.analysis.tracing.runs.smoothing import thin
from rig.model.effect import Array, Effect, Fit, Moved, Parameter, Port, Signals
from rig.model.effects.angle_dependent_stiffness import (
    MOTOR,
    OUTPUT,
    SECTOR,
    TOGETHER,
    AngleDependentStiffness,
)
from rig.model.effects.channel_time_skew import ALONG_RUN, AVERAGED, EACH_RUN, KNOTS, ChannelTimeSkew
from rig.model.effects.channel_time_skew import LOAD as LOAD_LATE
from rig.model.effects.channel_time_skew import MOTOR as MOTOR_LATE
from rig.model.effects.channel_time_skew import TORQUE as TORQUE_LATE
from rig.model.effects.encoder_interpolation_error import EncoderInterpolationError
from rig.model.effects.flexspline_frame_error import FlexsplineFrameError
from rig.model.effects.gravity_unbalance import GravityUnbalance
from rig.model.effects.hysteretic_stiffness import HystereticStiffness
from rig.model.effects.load_dependent_friction import LoadDependentFriction
from rig.model.effects.load_dependent_kinematic_error import EACH, ORDERS, TORQUE, LoadDependentKinematicError
from rig.model.effects.lost_motion import BY_ANGLE, LostMotion
from rig.model.effects.missed_counts import TURNED, MissedCounts
from rig.model.effects.nonlinear_stiffness import BELOW, CUBIC, EXPONENTIAL, KNEE, NonlinearStiffness
from rig.model.effects.output_once_per_rev import OutputOncePerRev
from rig.model.effects.position_dependent_friction import PositionDependentFriction
from rig.model.effects.presliding_friction import LOAD as LOAD_BUILDS_UP
from rig.model.effects.presliding_friction import MOTOR as BUILDS_UP
from rig.model.effects.presliding_friction import PreslidingFriction
from rig.model.effects.quadratic_drag import QuadraticDrag
from rig.model.effects.stribeck_friction import StribeckFriction
from rig.model.effects.support_compliance import ON_GROUND, ON_HOUSING, SupportCompliance
from rig.model.effects.thermal_friction_drift import CLOCK, HEAT, LOGGED, SOAK, ThermalFrictionDrift
from rig.model.effects.tooth_mesh_error import ToothMeshError
from rig.model.effects.torque_ripple import TorqueRipple
from rig.model.effects.torque_sensor_crosstalk import TorqueSensorCrosstalk
from rig.model.effects.torsional_mode import COUPLING, HUB, STIFF, TorsionalMode
from rig.model.fourier import FourierSeries
from rig.model.second_mode import coupling
from rig.model.second_mode.rates import following
from tests.contract.test_effects import KNOWN, REACH, N, motion

RAW, FACTOR = 1e-3, 4
STRAIGHT = dataclasses.replace(KNOWN, kinematic_error=FourierSeries((), ()))


@pytest.mark.parametrize("hz", [10.0, 60.0, 80.0, 125.0, 170.0, 250.0, 430.0, 510.0, 853.0, 990.0])
def test_a_fast_wave_is_in_the_columns_as_far_as_it_is_left_in_the_thinned_readings(hz: float) -> None:
    t = RAW * np.arange(20000)
    read, first = thin(np.cos(2 * np.pi * hz * t), FACTOR)
    s = dataclasses.replace(motion(n=read.size), dt=RAW * FACTOR, thinned=FACTOR)
    column = np.cos(2 * np.pi * hz * (t[first] + s.dt * np.arange(read.size))) * s.kept(
        1.0, np.full(read.size, 2 * np.pi * hz)
    )
    assert float(np.sqrt(np.mean((read - column) ** 2))) < 0.1


def test_readings_that_were_kept_as_they_are_keep_every_wave() -> None:
    assert (motion().kept(9000.0, np.full(5, 300.0)) == 1.0).all()


def test_heat_comes_from_friction_stays_with_a_slow_leak_and_goes_with_a_fast_one() -> None:
    gear = dataclasses.replace(KNOWN, tau_c=0.2, B_m=1e-3)
    run = Moved(start=100.0, end=150.0, speed=40.0, square=1600.0)
    power = 0.2 * 40.0 + 1e-3 * 1600.0
    at = dataclasses.replace(motion(n=4), t=np.array([50.0, 125.0, 150.0, 400.0]), gear=gear, past=(run,))
    np.testing.assert_allclose(at.heat(1e7), power * np.array([0.0, 25.0, 50.0, 50.0]), rtol=1e-4)
    np.testing.assert_allclose(at.heat(20.0)[1], power * 20.0 * (1 - np.exp(-25 / 20)))
    assert at.heat(20.0)[3] < 1e-3 * power
    later = dataclasses.replace(at, t=at.t[2:])  # the run had ended by then
    np.testing.assert_allclose(later.heat(20.0), at.heat(20.0)[2:])


def test_a_drive_is_cold_again_after_a_night_and_not_after_a_coffee() -> None:
    day = 86_400.0
    past = tuple(Moved(start, start + 60.0, 10.0, 100.0) for start in (0.0, 1000.0, day, day + 2000.0))
    at = dataclasses.replace(motion(n=2), past=past)
    for start, used in ((0.0, 0.0), (1000.0, 1000.0), (day, 0.0), (day + 2000.0, 2000.0)):
        there = dataclasses.replace(at, t=start + np.array([0.0, 50.0]))
        np.testing.assert_allclose(there.in_use, used + np.array([0.0, 50.0]))
    alone = dataclasses.replace(at, t=np.array([day, day + 50.0]), past=())
    np.testing.assert_allclose(alone.in_use, alone.t)


@pytest.mark.parametrize("side", [STIFF, COUPLING])
@pytest.mark.parametrize(("soft", "about", "within"), [(1e-3, 0.0, 2e-3), (0.05, 0.05, 1e-3)])
def test_a_coupling_twists_the_gear_away_from_what_the_encoder_reads(
    side: float, soft: float, about: float, within: float
) -> None:
    """The wave generator stands behind the encoder by the twist, where the gear's error and its lever are others."""
    s, p = motion(), KNOWN.kinematic_error
    behind = s.theta_m
    for _ in range(20):
        behind = s.theta_m - soft * s.torque * (1 / N - p.slope(behind))
    error, torque = behind_the_encoder(s, behind)
    ports = TorsionalMode().columns(s, (side, 70.0, 0.04, about))
    np.testing.assert_allclose(soft * ports[Port.KINEMATIC_ERROR][:, 0], error, atol=within * np.abs(error).max())
    np.testing.assert_allclose(soft * ports[Port.MOTOR_TORQUE][:, 0], torque, atol=within * np.abs(torque).max())


def behind_the_encoder(s: Signals, behind: Array) -> tuple[Array, Array]:
    """What θ̃ and the motor's torque gain when the wave generator stands at `behind` rad."""
    p = KNOWN.kinematic_error
    error = (s.theta_m - behind) / N + p.value(behind) - p.value(s.theta_m)
    return error, -s.torque * (p.slope(behind) - p.slope(s.theta_m))


@pytest.mark.slow
@pytest.mark.long
def test_a_coupling_swings_as_its_own_equation_of_motion_says() -> None:
    """J_2·(ω̇_m − ψ̈) = k·ψ + b·ψ̇ − T·(1/N − θ̃_p′(θ_m − ψ)) − f, integrated apart; the load shows how it turns."""
    s, p, omega, zeta, inertia, rubs = motion(), KNOWN.kinematic_error, 2 * np.pi * 9.0, 0.06, 5e-4, 0.04
    k, b = inertia * omega**2, 2 * zeta * omega * inertia

    def swing(t: float, state: Array) -> Array:
        theta, alpha, torque = (np.interp(t, s.t, x) for x in (s.theta_m, s.alpha_m, s.torque))
        load = torque * (1 / N - p.slope(np.array(theta - state[0]))) + rubs
        return np.array([state[1], alpha + load / inertia - omega**2 * state[0] - 2 * zeta * omega * state[1]])

    start = [(s.torque[0] * (1 / N - s.series_slope[0]) + rubs + inertia * s.alpha_m[0]) / k, 0.0]
    found = solve_ivp(swing, (s.t[0], s.t[-1]), start, t_eval=s.t, rtol=1e-9, atol=1e-12, max_step=s.dt)
    psi = found.y[0]
    accelerated = np.array([swing(t, y)[1] for t, y in zip(s.t, found.y.T, strict=True)])
    error, torque = behind_the_encoder(s, s.theta_m - psi)
    s = seen_from_the_load(s, s.theta_m - psi)
    s = dataclasses.replace(s, tau_m=s.torque * (1 / N - p.slope(s.theta_m - psi)) + rubs + KNOWN.J_m * s.alpha_m)
    ports = TorsionalMode().columns(s, (COUPLING, 70.0, 0.04, 1 / k))
    coefficients, on = np.array([1 / k, inertia / k, b / k, 1 / k, 0.0, inertia]), slice(20, -20)
    got = {port: (columns @ coefficients)[on] for port, columns in ports.items()}
    np.testing.assert_allclose(got[Port.KINEMATIC_ERROR], error[on], atol=0.02 * np.abs(error).max())
    want = (torque - inertia * accelerated)[on]
    # the lever is that of the twist at rest
    np.testing.assert_allclose(got[Port.MOTOR_TORQUE], want, atol=0.1 * np.abs(want).max())


def seen_from_the_load(s: Signals, theta_w: Array) -> Signals:
    """With the load where a wave generator at `theta_w` rad (n,) has it."""
    wound = following(s.torque / KNOWN.K, KNOWN.B_sp / KNOWN.K, s.dt)
    theta_l = theta_w / N - KNOWN.kinematic_error.value(theta_w) - wound
    omega_l = np.gradient(theta_l, s.dt)
    return dataclasses.replace(s, theta_l=theta_l, omega_l=omega_l, alpha_l=np.gradient(omega_l, s.dt))


def test_how_a_wave_generator_turns_is_read_from_the_load() -> None:
    s = motion()
    turned = s.theta_m - 0.01 * np.sin(2 * np.pi * 5.0 * s.t)
    omega, alpha = coupling.wave_generator(seen_from_the_load(s, turned))
    inside = slice(20, -20)
    np.testing.assert_allclose(omega[inside], np.gradient(turned, s.dt)[inside], atol=2e-3)
    want = np.gradient(np.gradient(turned, s.dt), s.dt)[inside]
    np.testing.assert_allclose(alpha[inside], want, atol=0.02 * np.abs(want).max())


def test_mesh_friction_of_exponent_one_is_a_share_of_the_torque() -> None:
    s = motion()
    column = LoadDependentFriction().columns(s, (0.0, 1.0, 0.0))[Port.MOTOR_TORQUE][:, 0]
    np.testing.assert_allclose(column, np.abs(s.torque) / N * s.way, atol=1e-15)


def test_mesh_friction_that_saturates_is_told_at_the_same_torque_and_by_where_it_does() -> None:
    s = dataclasses.replace(motion(), torque=np.full(4000, 20.0))
    law = LoadDependentFriction()
    column = law.columns(s, (0.0, 0.45, 1.0))[Port.MOTOR_TORQUE][:, 0]
    np.testing.assert_allclose(column, 20.0 / N * s.way)
    flat = law.columns(dataclasses.replace(s, torque=np.full(4000, 200.0)), (0.0, 0.45, 1.0))[Port.MOTOR_TORQUE][:, 0]
    np.testing.assert_allclose(flat, column / (1 - np.exp(-1 / 0.45)))
    told = law.parameters(Fit(np.array([0.05]), (0.0, 0.45, 1.0), 1e-4 * np.eye(4), KNOWN, N))
    assert [(p.name, p.unit) for p in told] == [("mu_L", "1"), ("T_s", "N·m")]
    assert told[1].value == pytest.approx(9.0)
    assert told[1].ci95[1] > 9.1


def test_a_hub_that_swings_on_the_torque_sensor_by_itself_loads_no_gear() -> None:
    """With the load at rest and the torque at the hub's own frequency the gear is not wound up, damper or not."""
    inertia, hz = 0.05, 4.0
    s = motion()
    omega = 2 * np.pi * hz
    torque = 5.0 * np.sin(omega * s.t)
    s = dataclasses.replace(s, torque=torque, torque_rate=5.0 * omega * np.cos(omega * s.t), alpha_l=0.0 * s.t)
    s = dataclasses.replace(s, omega_m=np.full(s.t.size, 20.0))  # rad/s: orders of the gear shake it
    wind_up = TorsionalMode().columns(s, (HUB, 70.0, 0.04, 0.0))[Port.WIND_UP] @ np.array([inertia, 1.0 / omega**2])
    inside, tau = slice(20, -20), KNOWN.B_sp / KNOWN.K
    late = 5.0 * (np.sin(omega * s.t) - tau * omega * np.cos(omega * s.t)) / (1 + (tau * omega) ** 2)
    np.testing.assert_allclose(wind_up[inside], -late[inside] / KNOWN.K, atol=2e-3 * 5.0 / KNOWN.K)


@pytest.mark.parametrize("tau", [0.0, 1e-4, 1e-3, 0.1])
def test_what_follows_is_a_first_order_behind_at_any_time_constant(tau: float) -> None:
    dt, omega = 2e-3, 2 * np.pi * 20.0
    t = np.arange(1000) * dt
    gone = np.exp(-t / tau) if tau else 0.0 * t
    late = (np.sin(omega * t) - tau * omega * (np.cos(omega * t) - gone)) / (1 + (tau * omega) ** 2)
    np.testing.assert_allclose(following(np.sin(omega * t), tau, dt), late, atol=6e-3)
    np.testing.assert_allclose(following(np.full(5, 3.0), tau, dt), 3.0, atol=1e-12)


def test_an_inertia_on_a_soft_sensor_is_told_whole() -> None:
    """Of 40 g·m² on 5600 N·m/rad beside a gear of 7400 the gear gives by 0.43 of J_2/K, K being that of both."""
    J_2, k, K = 0.04, 5600.0, 1 / (1 / 7400.0 + 1 / 5600.0)
    fit = Fit(
        np.array([J_2 * K / 7400.0, J_2 / k]),
        (HUB, 71.0, 0.04, 0.0),
        np.zeros((6, 6)),
        dataclasses.replace(KNOWN, K=K),
        N,
    )
    assert TorsionalMode().parameters(fit)[0].value == pytest.approx(J_2, rel=1e-9)
    assert TorsionalMode().softens(fit)[0] == pytest.approx(1 / k, rel=1e-9)


@pytest.mark.parametrize(("square", "told"), [(2.8e-6, True), (-1.1e-6, False), (4e-7, False)])
def test_a_hub_on_a_spring_too_stiff_to_be_seen_has_an_inertia_and_no_frequency(square: float, told: bool) -> None:
    """1/ω² known to ±1e-6 s²; the spring's frequency is told where that is not nothing."""
    spread = np.diag([1e-3, 0.5e-6, 0.0, 0.0, 0.0, 0.0]) ** 2
    fit = Fit(np.array([0.06, square]), (HUB, 71.0, 0.04, 0.0), spread, KNOWN, N)
    law = TorsionalMode()
    assert law.plausible(fit)
    assert [p.name for p in law.parameters(fit)] == ["J_2", *(["hub_frequency"] if told else [])]
    assert (law.softens(fit)[0] > 0) is told
    assert not law.plausible(dataclasses.replace(fit, coefficients=np.array([0.06, -9e-6])))
    assert not law.plausible(dataclasses.replace(fit, coefficients=np.array([-0.06, square])))


@pytest.mark.parametrize("side", [MOTOR, OUTPUT])
def test_a_modulated_spring_pushes_the_shaft_whose_angle_it_follows(side: float) -> None:
    """−∂/∂θ of ½·T²/K(θ) at constant torque, by finite differences: what resists is its negative."""
    s, h, kappa = motion(), 1e-6, 0.05 / KNOWN.K
    port = Port.MOTOR_TORQUE if side == MOTOR else Port.LOAD_TORQUE
    theta = s.theta_m if side == MOTOR else s.theta_l
    energy = [0.5 * s.torque**2 * kappa * np.cos(2.0 * (theta + by)) for by in (h, -h)]
    columns = AngleDependentStiffness().columns(s, (2.0, 1.0, side))
    np.testing.assert_allclose(kappa * columns[port][:, 0], -(energy[0] - energy[1]) / (2 * h), atol=1e-7)
    np.testing.assert_allclose(columns[Port.WIND_UP][:, 0], s.torque * np.cos(2.0 * theta), atol=1e-12)


def test_a_knee_at_no_torque_is_a_gap_and_no_spring() -> None:
    effect = NonlinearStiffness()
    least = effect.bounds(REACH)[1][0]
    assert effect.beyond((KNEE, least), REACH)
    assert not effect.beyond((KNEE, 3.0), REACH)
    assert not effect.beyond((CUBIC, least), REACH)


def test_orders_that_shrink_alike_are_the_law_of_the_whole_series() -> None:
    s, effect = motion(), LoadDependentKinematicError()
    whole, apart = (effect.columns(s, (of, 3.0, 3e-3, 1.0)) for of in (TORQUE, TORQUE + EACH))
    series = s.gear.kinematic_error
    a, b = ((*part, *4 * (0.0,)) for part in (series.a, series.b))
    alike = np.array([*(a[n - 1] for n in ORDERS), *(b[n - 1] for n in ORDERS), 1.0, 0.0])
    for port in (Port.KINEMATIC_ERROR, Port.LEVER):
        np.testing.assert_allclose(apart[port] @ alike, whole[port][:, 0], atol=1e-12)


def test_what_is_not_one_of_the_large_orders_may_turn_by_an_angle() -> None:
    """The last two columns: the rest, and what it changes by for a rad of turn; orders 3 and 5 are all of the rest."""
    s = motion()
    third = FourierSeries((0.0, 0.0, 2e-4, 0.0, 1e-4), (0.0, 0.0, 1e-4, 0.0, -3e-5))
    s = dataclasses.replace(s, gear=dataclasses.replace(s.gear, kinematic_error=third))
    columns = LoadDependentKinematicError().columns(s, (TORQUE + EACH, 3.0, 3e-3, 1.0))
    h = 1e-5
    for port, of in ((Port.KINEMATIC_ERROR, third.value), (Port.LEVER, third.slope)):
        per_turn = (of(s.theta_m + h) - of(s.theta_m - h)) / (2 * h)
        rest, turned = columns[port][:, 6], columns[port][:, 7]
        np.testing.assert_allclose(turned * of(s.theta_m), per_turn * rest, atol=1e-14)
        assert np.ptp(turned) > 0


@pytest.mark.parametrize("of", [TORQUE, TORQUE + EACH])
def test_orders_without_load_are_what_stays_and_what_goes_away(of: float) -> None:
    effect, shape = LoadDependentKinematicError(), (of, 3.0, 3e-3, 1.0)
    s = dataclasses.replace(motion(), torque=np.zeros(motion().t.size))
    column = effect.columns(s, shape)[Port.KINEMATIC_ERROR]
    c = np.linspace(0.4, 1.6, column.shape[1])
    told = np.array([effect.unloaded(n, s.gear, shape) @ c for n in range(1, 16)])
    series = FourierSeries(tuple(told[:, 0]), tuple(told[:, 1]))
    np.testing.assert_allclose(series.value(s.theta_m), column @ c, atol=1e-12)


def test_the_share_of_an_order_that_stays_is_told_with_its_interval_whatever_the_phase_of_what_goes() -> None:
    series = FourierSeries((0.0, 3e-5, 0.0, 1e-5), (0.0, 4e-5, 0.0, 0.0))
    known = dataclasses.replace(KNOWN, kinematic_error=series)
    gone = np.array([0.0, 12e-5, 0.0, 0.0, 16e-5, 0.0, 0.0])  # of orders 1, 2, 4: four times what stays of the second
    fit = Fit(gone, (TORQUE + EACH, 2.0, 3e-3, 1.0), np.diag([1e-12] * 7 + [0.0] * 4), known, N)
    found = {p.name: p for p in LoadDependentKinematicError().parameters(fit)}
    assert found["A_inf"].value == pytest.approx(0.2)
    assert found["A_inf"].ci95[1] - found["A_inf"].value == pytest.approx(1.96 * 0.2 * 1e-6 / 25e-5, rel=1e-4)
    assert found["A_inf_order_4"].value == pytest.approx(1.0)
    assert LoadDependentKinematicError().plausible(fit)
    assert not LoadDependentKinematicError().plausible(dataclasses.replace(fit, coefficients=-0.5 * gone / 4))


@pytest.mark.parametrize("each", [0.0, EACH])
def test_a_share_is_known_no_better_than_what_stays_where_no_load_takes_all_that_goes(each: float) -> None:
    series = FourierSeries((0.0, 3e-5), (0.0, 4e-5))
    known = dataclasses.replace(KNOWN, kinematic_error=series)
    stays, goes = 5e-5, 7.5e-5  # rad, of order 2 without load, along one phase
    gone = np.array([0.0, 4.5e-5, 0.0, 0.0, 6e-5, 0.0, 0.0]) if each else np.array([goes / stays])
    fit = Fit(gone, (TORQUE + each, 2.0, 3e-3, 1.0), np.zeros((gone.size + 4, gone.size + 4)), known, N)
    # both together, as slow runs tell them, are known exactly: what one has more the other has less
    along = np.zeros(gone.size + 4 + 4)
    along[-2:] = 1e-6 * np.array([0.6, 0.8])
    along[[1, 4] if each else [0]] = -1e-6 * (np.array([0.6, 0.8]) if each else 1 / stays)
    joint = np.outer(along, along)
    fit = dataclasses.replace(fit, covariance=joint[: gone.size + 4, : gone.size + 4], beside_series=joint)
    (share, *_) = LoadDependentKinematicError().parameters(fit)
    assert share.value == pytest.approx(0.4)
    assert share.ci95[1] - share.value == pytest.approx(1.96 * 1e-6 / (stays + goes), rel=1e-4)


def test_a_cubic_spring_is_solved_exactly_and_is_its_cube_where_that_is_small() -> None:
    s, stiffness, k_3 = motion(), KNOWN.K, 2.3e9
    scale = np.sqrt(stiffness**3 / k_3)  # where the cubic part is as large as the other
    column = NonlinearStiffness().columns(s, (CUBIC, scale))[Port.WIND_UP][:, 0]
    phi = (s.torque + column) / stiffness
    np.testing.assert_allclose(stiffness * phi + k_3 * phi**3, s.torque, atol=1e-9)
    far = NonlinearStiffness().columns(s, (CUBIC, 3000.0))[Port.WIND_UP][:, 0]
    np.testing.assert_allclose(far, -(s.torque**3) / 3000.0**2, atol=1e-3 * np.abs(far).max())


@pytest.mark.parametrize("kind", [EXPONENTIAL, KNEE, CUBIC, BELOW])
def test_what_a_bent_spring_gives_at_a_torque_is_the_slope_of_its_column(kind: float) -> None:
    at, law, step = np.array([-31.0, -7.0, -0.5, 0.0, 2.0, 12.0, 40.0]), NonlinearStiffness(), 1e-5
    ends = [dataclasses.replace(motion(n=at.size), torque=at + sign * step) for sign in (1.0, -1.0)]
    up, down = (law.columns(s, (kind, 11.0))[Port.WIND_UP] for s in ends)
    np.testing.assert_allclose(law.gives(at, (kind, 11.0)), (up - down) / (2 * step), atol=2e-6)


def test_the_cubic_coefficient_is_told_whatever_the_scale_it_was_fitted_with() -> None:
    fit = Fit(np.array([2e-6]), (CUBIC, 200.0), np.zeros((3, 3)), KNOWN, N)
    (found,) = NonlinearStiffness().parameters(fit)
    assert (found.name, found.unit) == ("k_3", "N·m/rad³")
    assert found.value == pytest.approx(2e-6 * KNOWN.K**4 / 200.0**2)


def test_a_housing_shows_in_both_angles_or_in_the_wind_up_as_its_encoders_are_held() -> None:
    s = motion()
    ridden, grounded = (SupportCompliance().columns(s, (held, 40.0, 0.05)) for held in (ON_HOUSING, ON_GROUND))
    assert set(ridden) == {Port.READS_THETA_L, Port.READS_THETA_M}
    assert set(grounded) == {Port.WIND_UP}
    np.testing.assert_allclose(ridden[Port.READS_THETA_L][:, 0], s.torque, atol=0.05 * np.abs(s.torque).max())
    beyond = ridden[Port.READS_THETA_L] - s.torque[:, None]  # of the rest the gear only seems softer, and K has that
    np.testing.assert_allclose(grounded[Port.WIND_UP], beyond, atol=1e-12)


def test_no_housing_swings_in_a_slow_run_and_none_is_shaken_when_a_motor_speeds_up() -> None:
    """Below 3 rad/s it is compliance alone; above, it has swung all along: a load that is held makes no step of it."""
    s = dataclasses.replace(motion(), torque=np.full(4000, 30.0), omega_m=np.linspace(0.0, 6.0, 4000))
    column = SupportCompliance().columns(s, (ON_GROUND, 20.0, 0.02))[Port.WIND_UP][:, 0]
    np.testing.assert_allclose(column, 0.0, atol=1e-9)
    noisy = dataclasses.replace(s, torque=s.torque + np.sin(2 * np.pi * 20.0 * s.t))
    column = SupportCompliance().columns(noisy, (ON_GROUND, 20.0, 0.02))[Port.WIND_UP][:, 0]
    assert not column[:1900].any()
    assert float(np.ptp(column[3000:])) > 10 * float(np.ptp(noisy.torque))


@pytest.mark.parametrize(("driven", "can_be"), [(0.03, True), (-0.002, True), (-0.02, False)])
def test_a_loss_gives_no_energy_back_when_the_load_drives(driven: float, can_be: bool) -> None:
    fit = Fit(np.array([0.03, driven]), (1.0, 1.0, 0.0), np.zeros((5, 5)), KNOWN, N)
    assert LoadDependentFriction().plausible(fit) is can_be


@pytest.mark.parametrize("late", [0.0, 4e-3])
def test_a_late_torque_reads_what_was_and_will_read_what_is(late: float) -> None:
    s = motion()
    column = ChannelTimeSkew().columns(s, (TORQUE_LATE, late, 0.0))[Port.READS_TAU_L][:, 0]
    delta = late or 1e-4
    now = 25.0 * np.sin(2 * np.pi * 0.7 * (s.t + delta) + 0.2)
    np.testing.assert_allclose(delta * column[20:-20], (s.torque - now)[20:-20], atol=2e-3 * 25.0 * delta / 1e-3)


def test_a_torque_that_is_the_mean_of_a_while_is_late_and_blunt() -> None:
    """Of 12 ms, at 8 and 17 Hz: to a hundredth of what it does, and a delay alone leaves many times that."""
    w, t = 12e-3, 1e-3 * np.arange(6000)
    waves = [(2 * np.pi * f, phase) for f, phase in ((8.0, 0.3), (17.0, 1.1))]
    true = sum(np.cos(o * t + p) for o, p in waves)
    read = sum(np.sinc(o * w / 2 / np.pi) * np.cos(o * (t - w / 2) + p) for o, p in waves)
    rate = sum(-o * np.sinc(o * w / 2 / np.pi) * np.sin(o * (t - w / 2) + p) for o, p in waves)
    s = dataclasses.replace(motion(n=t.size), t=t, dt=1e-3, torque=read, torque_rate=rate)
    effect, inner = ChannelTimeSkew(), slice(100, -100)
    too_much = (read - true)[inner]
    for law, least, most in ((AVERAGED, 0.0, 0.01), (0.0, 0.03, 0.3)):
        z = effect.columns(s, (TORQUE_LATE, w / 2, law))[Port.READS_TAU_L][inner]
        found = np.linalg.lstsq(z, too_much, rcond=None)[0]
        assert least < np.std(too_much - z @ found) / np.std(too_much) < most
        assert found[0] == pytest.approx(w / 2, rel=0.05)
        if law:
            fit = Fit(found, (TORQUE_LATE, w / 2, law), np.zeros((5, 5)), KNOWN, N)
            told = {p.name: p for p in effect.parameters(fit)}["window_tau_l"]
            assert told.ci95[0] < w < told.ci95[1]
            assert effect.plausible(fit)
            assert not effect.plausible(dataclasses.replace(fit, coefficients=found * np.array([1.0, -1.0])))
            assert not effect.plausible(dataclasses.replace(fit, coefficients=found * np.array([0.2, 1.0])))


@pytest.mark.parametrize(("late", "is_one"), [(1.3e-4, False), (2.9e-4, False), (5e-4, True), (-2e-4, True)])
def test_a_torque_as_late_as_its_own_low_pass_makes_it_is_no_skew(late: float, is_one: bool) -> None:
    fit = Fit(np.array([late]), (TORQUE_LATE, 0.0, 0.0), np.zeros((4, 4)), KNOWN, N)
    assert ChannelTimeSkew().plausible(fit) == is_one
    assert ChannelTimeSkew().plausible(dataclasses.replace(fit, shape=(LOAD_LATE, 0.0, 0.0)))


@pytest.mark.parametrize(("sizes", "are_lost"), [((1.7e-3, -1.69e-3), False), ((1e-4, 2e-4), True), ((3e-4,), True)])
def test_counts_that_come_back_at_another_speed_are_none_that_were_lost(
    sizes: tuple[float, ...], are_lost: bool
) -> None:
    fits = [Fit(np.array([x]), (TURNED, 0.5 + i), np.zeros((3, 3)), KNOWN, N) for i, x in enumerate(sizes)]
    assert MissedCounts().plausible_together(fits) == are_lost


@pytest.mark.parametrize("late", [5e-3, 0.02, -0.02])
def test_a_late_load_angle_reads_what_was_however_late(late: float) -> None:
    """By a quarter of a period of 13 Hz and more: no series in the lateness holds there."""
    t, omega = motion(n=3000).dt * np.arange(3000), 2 * np.pi * 13.0
    s = dataclasses.replace(motion(n=3000), t=t, theta_l=0.01 * t + 1e-4 * np.sin(omega * t))
    s = dataclasses.replace(s, omega_l=0.01 + 1e-4 * omega * np.cos(omega * t))
    column = ChannelTimeSkew().columns(s, (LOAD_LATE, late, 0.0))[Port.READS_THETA_L][:, 0]
    now = 0.01 * (t + late) + 1e-4 * np.sin(omega * (t + late))
    np.testing.assert_allclose(late * column[40:-40], (s.theta_l - now)[40:-40], atol=2e-6)


@pytest.mark.parametrize(("frequency", "zeta", "beyond"), [(40.0, 0.2, False), (40.0, 0.45, True), (90.0, 0.05, True)])
def test_a_housing_that_does_not_swing_is_no_mode(frequency: float, zeta: float, beyond: bool) -> None:
    band = replace(REACH, band=45.0)
    assert SupportCompliance().beyond((ON_HOUSING, frequency, zeta), band) == beyond


def test_a_steeper_fall_goes_faster_beyond_its_torque_and_slower_below() -> None:
    s, effect = motion(), LoadDependentKinematicError()
    even, steep = (effect.columns(s, (TORQUE, 5.0, 1e-4, d))[Port.KINEMATIC_ERROR][:, 0] for d in (1.0, 2.0))
    value = s.series_value
    light, heavy = np.abs(s.torque) < 2.0, np.abs(s.torque) > 15.0
    assert (even[light] / value[light]).mean() < (steep[light] / value[light]).mean()
    assert (even[heavy] / value[heavy]).mean() > (steep[heavy] / value[heavy]).mean()


@pytest.mark.parametrize(("sizes", "may"), [((0.35, 0.42, 0.0, 0.08), True), ((0.1, 0.1, 0.2, 0.0), False)])
def test_a_torque_sensor_may_feel_bending_more_strongly_twice_an_output_turn_and_not_thrice(
    sizes: tuple[float, ...], may: bool
) -> None:
    c = np.array([x for size in (*sizes, 0.0) for x in (size, 0.0)])
    fit = Fit(c, (1.0, 5.0), 1e-6 * np.eye(c.size), KNOWN, N)
    assert TorqueSensorCrosstalk().plausible(fit) is may


def test_a_flattened_weight_has_a_third_wave_smaller_than_half_of_the_first() -> None:
    effect, turn = GravityUnbalance(), np.linspace(0.0, 2 * np.pi, 500)
    s = dataclasses.replace(motion(n=500), theta_l=turn)
    z = effect.columns(s, (1.0, 3.0))[Port.LOAD_TORQUE]
    c = np.linalg.lstsq(z, np.tanh(1.8 * np.sin(turn)), rcond=None)[0]
    fit = Fit(c, (1.0, 3.0), np.eye(6), KNOWN, N)
    assert effect.plausible(fit)
    assert {p.name for p in effect.parameters(fit)} >= {"unbalance_amplitude", "three_times_a_turn_amplitude"}
    assert not effect.plausible(dataclasses.replace(fit, coefficients=c[[2, 3, 0, 1]]))


@pytest.mark.parametrize(("twice", "may"), [(0.09, True), (0.11, False)])
def test_what_pulls_twice_a_turn_pulls_less_than_the_weight(twice: float, may: bool) -> None:
    """0.15 N·m once a turn; two thirds of it twice a turn are a cable that holds the load over some of its turn."""
    sizes = ((1.0, 0.15), (2.0, twice))
    fits = [Fit(np.array([0.0, size]), (order, 0.0), np.eye(4), KNOWN, N) for order, size in sizes]
    assert GravityUnbalance().plausible_together(fits) is may
    assert GravityUnbalance().plausible_together(fits[:1])


def test_a_load_that_is_locked_passes_no_line_of_its_encoder() -> None:
    effect = EncoderInterpolationError()
    turning = {shape for shape in effect.shapes(REACH) if shape[0] == 1.0}
    assert (1.0, 10125.0) in turning
    locked = effect.shapes(dataclasses.replace(REACH, slowest=0.02, slowest_free=0.0))
    assert {side for side, _ in locked} == {0.0}
    # however slowly the motor turns in lock tests
    assert {x for x in effect.shapes(dataclasses.replace(REACH, slowest=0.02)) if x[0] == 1.0} == turning


@pytest.mark.parametrize(
    ("effect", "port"),
    [(OutputOncePerRev(), Port.KINEMATIC_ERROR), (TorqueSensorCrosstalk(), Port.READS_TAU_L)],
)
def test_a_lobe_once_a_turn_of_the_output_has_overtones_smaller_than_itself(effect: Effect, port: Port) -> None:
    s = motion(n=20000)
    lobe = 1e-4 * np.exp(1.5 * np.cos(s.theta_l - 1.0))
    columns = effect.columns(s, (1.0, 5.0))[port]
    assert columns.shape == (20000, 10)
    with_mean = np.column_stack([columns, np.ones(s.t.size)])
    c = np.linalg.lstsq(with_mean, lobe, rcond=None)[0]
    assert float(np.std(lobe - with_mean @ c)) < 0.01 * float(np.std(lobe))
    fit = Fit(c[:-1], (1.0, 5.0), np.zeros((12, 12)), KNOWN, N)
    assert effect.plausible(fit)
    told = {p.name: p.value for p in effect.parameters(fit)}
    assert told["order_1_amplitude"] > told["order_2_amplitude"] > told["order_3_amplitude"] > 0
    # a torque sensor may feel bending twice a turn; a third wave above it is no lobe to either
    later = 2 if isinstance(effect, OutputOncePerRev) else 4
    assert not effect.plausible(dataclasses.replace(fit, coefficients=np.roll(c[:-1], later)))


@pytest.mark.parametrize("side", [BUILDS_UP, LOAD_BUILDS_UP])
def test_friction_that_builds_up_is_constant_friction_where_the_run_began_in_motion(side: float) -> None:
    """A run that begins in motion has slid before; one that begins at rest has all its friction to build up."""
    moving, effect = motion(n=200), PreslidingFriction()
    (column,) = effect.columns(moving, (side, 0.2, 0.0)).values()
    np.testing.assert_array_equal(column, 0.0)
    resting = dataclasses.replace(moving, omega_m=moving.omega_m * np.linspace(0.0, 1.0, 200))
    (column,) = effect.columns(resting, (side, 0.2, 0.0)).values()
    assert column[1:].max() < 0
    assert column[1, 0] < -0.5


def test_a_housing_has_modes_of_its_own_frequencies_and_the_same_one_only_once() -> None:
    at = [Term(SupportCompliance(), (ON_GROUND, hz, 0.05)) for hz in (20.0, 22.0, 29.0)]
    assert _same(at[0], at[1])
    assert not _same(at[0], at[2])
    assert not _same(at[2], at[0])
    coupled = [Term(TorsionalMode(), (STIFF, hz, 0.05, 0.0)) for hz in (20.0, 80.0)]
    assert _same(*coupled)


def test_teeth_under_an_untrue_wave_generator_have_orders_beside_their_own() -> None:
    orders = {shape[0] for shape in ToothMeshError().shapes(REACH)}
    assert orders >= {2 * N - 2, 2 * N, 2 * N + 2, 2 * N + 4}
    assert orders >= {N, N + 1}  # where every second tooth is another one


def test_a_fall_between_creep_and_the_slowest_run_is_known_by_its_upper_end() -> None:
    effect = StribeckFriction()
    assert effect.is_scaled(Parameter("omega_s", 0.3, (-2.0, 4.0), "rad/s"), REACH)
    assert not effect.is_scaled(Parameter("omega_s", 9.0, (-20.0, 38.0), "rad/s"), REACH)
    assert not NonlinearStiffness().is_scaled(Parameter("T_0", 0.3, (-2.0, 4.0), "N·m"), REACH)


def test_what_an_oil_film_leaves_of_friction_at_rest_falls_to_half_and_goes_on_for_longer() -> None:
    effect, s = StribeckFriction(), dataclasses.replace(motion(n=3), omega_m=np.array([0.0, 2.0, 20.0]), way=np.ones(3))
    film, fall = (effect.columns(s, (2.0, 2.0, 0.0, law))[Port.MOTOR_TORQUE][:, 0] for law in (1.0, 0.0))
    np.testing.assert_allclose(film, [1.0, 0.5, 1 / 101])
    assert fall[2] < 1e-40
    told = effect.parameters(Fit(np.array([0.2]), (2.0, 2.0, 0.0, 1.0), np.eye(3), KNOWN, N))
    assert [p.name for p in told] == ["tau_s_minus_tau_c", "omega_s", "p"]


def test_a_fan_of_curved_blades_drags_otherwise_backwards() -> None:
    effect = QuadraticDrag()
    ways = [effect.columns(motion(sign), (1.0, 2.0, 0.0))[Port.MOTOR_TORQUE] for sign in (1.0, -1.0)]
    whole = [effect.columns(motion(sign), (0.0, 2.0, 0.0))[Port.MOTOR_TORQUE][:, 0] for sign in (1.0, -1.0)]
    for i, (columns, drag) in enumerate(zip(ways, whole, strict=True)):
        np.testing.assert_array_equal(columns[:, i], drag)
        assert not columns[:, 1 - i].any()


def test_heat_that_soaks_in_falls_with_the_root_of_the_time() -> None:
    at = dataclasses.replace(motion(n=3), t=np.array([0.0, 1.0, 4.0]), way=np.ones(3))
    column = ThermalFrictionDrift().columns(at, (1e4, SOAK, 1e-3))[Port.MOTOR_TORQUE][:, 0]
    np.testing.assert_allclose((column[0] - column[1:]) / (column[0] - column[1]), [1.0, 2.0], rtol=0.01)


def test_a_warm_up_that_outlasts_the_campaign_is_known_without_its_end() -> None:
    effect = ThermalFrictionDrift()
    assert effect.is_scaled(Parameter("t_w", 1.5 * REACH.duration, (-9e3, 2e4), "s"), REACH)
    assert not effect.is_scaled(Parameter("t_w", 0.1 * REACH.duration, (-9e3, 2e4), "s"), REACH)


def test_friction_that_grows_with_the_time_is_no_warming_up() -> None:
    effect, unsure = ThermalFrictionDrift(), np.eye(5)
    for law in (CLOCK, HEAT, SOAK):
        assert effect.plausible(Fit(np.array([0.02, -1e-3]), (700.0, law, 1e-3), unsure, KNOWN, N))
        assert not effect.plausible(Fit(np.array([-0.02, 1e-3]), (700.0, law, 1e-3), unsure, KNOWN, N))


def test_clocks_that_run_apart_make_the_skew_grow_with_the_time() -> None:
    effect, s = ChannelTimeSkew(), motion()
    late = dataclasses.replace(s, t=s.t + 500.0)
    for side in (LOAD_LATE, MOTOR_LATE, TORQUE_LATE):
        (steady,) = effect.columns(late, (side, 0.0, 0.0)).values()
        (drifting,) = effect.columns(late, (side, 0.0, 1.0)).values()
        np.testing.assert_allclose(drifting[:, 0], steady[:, 0])
        np.testing.assert_allclose(drifting[:, 1], steady[:, 0] * late.t / 1000.0)
    assert effect.about((LOAD_LATE, 0.0, 1.0), np.array([1e-3, 1e-3])) == (LOAD_LATE, 0.0, 1.0)


def test_clocks_that_are_set_anew_for_every_run_make_the_skew_grow_along_each() -> None:
    effect, s = ChannelTimeSkew(), motion()
    late = dataclasses.replace(s, t=s.t + 500.0)
    for signals in (late, late.part(slice(40, None))):
        (steady,) = effect.columns(signals, (LOAD_LATE, 0.0, 0.0)).values()
        (drifting,) = effect.columns(signals, (LOAD_LATE, 0.0, EACH_RUN)).values()
        np.testing.assert_allclose(drifting[:, 0], steady[:, 0])
        np.testing.assert_allclose(drifting[:, 1], steady[:, 0] * (signals.t - late.t[0]) / 1000.0)


def test_a_skew_may_follow_a_curve_along_each_run() -> None:
    """The same one in all of them: a part of a run has its part of it."""
    effect, s = ChannelTimeSkew(), motion()
    (steady,) = effect.columns(s, (LOAD_LATE, 0.0, 0.0)).values()
    (curved,) = effect.columns(s, (LOAD_LATE, 0.0, ALONG_RUN)).values()
    share = (s.t - s.t[0]) / (s.t[-1] - s.t[0])
    np.testing.assert_allclose(curved.sum(1), steady[:, 0])
    np.testing.assert_allclose(curved @ KNOTS, steady[:, 0] * share)
    (part,) = effect.columns(s.part(slice(40, None)), (LOAD_LATE, 0.0, ALONG_RUN)).values()
    np.testing.assert_allclose(part, curved[40:])
    delays = np.interp(KNOTS, np.linspace(0, 1, 7), 1e-4 * np.array([1.0, 2.0, 3.0, 2.0, 1.0, 0.0, -1.0]))
    fit = Fit(delays, (LOAD_LATE, 0.0, ALONG_RUN), 1e-12 * np.eye(KNOTS.size + 3), KNOWN, N)
    mean, change = effect.parameters(fit)
    assert mean.name == "skew_theta_l"
    assert mean.value == pytest.approx(8e-4 / 6)
    assert change.value == pytest.approx(4e-4)
    assert not change.holds_zero


def test_a_soft_zone_may_end_as_it_began() -> None:
    """Far beyond T_0 the spring is where it would be without one."""
    s = dataclasses.replace(motion(), torque=np.linspace(-40.0, 40.0, motion().t.size))
    more = NonlinearStiffness().columns(s, (BELOW, 8.0))[Port.WIND_UP][:, 0]
    near = np.abs(s.torque) < 1.0
    np.testing.assert_allclose(more[near], s.torque[near], rtol=0.02)
    np.testing.assert_allclose(more, -more[::-1], atol=1e-12)
    assert np.abs(more[np.abs(s.torque) > 30.0]).max() < 1e-4


def test_no_torque_sensor_is_late_where_there_is_none() -> None:
    there = {shape[0] for shape in ChannelTimeSkew().shapes(REACH)}
    assert there == {LOAD_LATE, MOTOR_LATE, TORQUE_LATE}
    without = dataclasses.replace(REACH, has=REACH.has - {"tau_l"})
    assert {shape[0] for shape in ChannelTimeSkew().shapes(without)} == {LOAD_LATE, MOTOR_LATE}


def test_a_field_that_the_current_turns_is_a_ripple_that_grows_with_the_torque() -> None:
    """τ·cos(kθ + c·τ) by its two pairs, where the turn is small."""
    s, c = motion(), 0.1
    z = TorqueRipple().columns(s, (12.0, 1.0))[Port.MOTOR_TORQUE]
    turned = s.tau_m * np.cos(12.0 * s.theta_m + c * s.tau_m)
    coefficients = np.linalg.lstsq(z, turned, rcond=None)[0]
    np.testing.assert_allclose(coefficients, [1.0, 0.0, 0.0, -c], atol=0.01)
    fit = Fit(coefficients, (12.0, 1.0), np.eye(6), KNOWN, N)
    assert TorqueRipple().plausible(fit)
    assert not TorqueRipple().plausible(dataclasses.replace(fit, coefficients=coefficients[[3, 2, 1, 0]]))


@pytest.mark.parametrize("law", [HystereticStiffness.FRICTION, HystereticStiffness.SPRINGS_BACK])
def test_friction_beside_spring_and_damper_leaves_the_damper_what_it_is(law: float) -> None:
    """K·φ + B_sp·φ̇ + T_f·z = T, stepped finely with a z of its own: 12 Hz, as near the resonance of a rig at speed."""
    n, fine, held, x_0 = 8000, 20, 0.7, 1.2e-3  # N·m, rad
    t = np.arange(n * fine) * 1e-3 / fine
    torque = 8.0 * np.sin(2 * np.pi * 12.0 * t) + 12.0 * np.sin(2 * np.pi * 1.7 * t)
    phi, z = np.zeros(t.size), 0.0
    for i in range(t.size - 1):
        step = (torque[i] - KNOWN.K * phi[i] - held * z) / KNOWN.B_sp * (t[1] - t[0])
        falls = law == HystereticStiffness.SPRINGS_BACK and step * z < 0
        z += (step if falls else step - abs(step) * z) / x_0
        phi[i + 1] = phi[i] + step
    torque, phi = torque[::fine], phi[::fine]
    s = dataclasses.replace(motion(n=n), dt=1e-3, torque=torque, theta_m=np.zeros(n), theta_l=-phi, gear=STRAIGHT)
    state = HystereticStiffness().columns(s, (x_0 * KNOWN.K, law))[Port.WIND_UP][:, 0]
    rate, bend = np.gradient(torque, 1e-3), np.gradient(np.gradient(torque, 1e-3), 1e-3)
    columns = np.stack([torque, rate, bend, state], 1)[100:-100]
    compliance, damping, _, friction = np.linalg.lstsq(columns, phi[100:-100], rcond=None)[0]
    assert 1 / compliance == pytest.approx(KNOWN.K, rel=2e-3)
    assert -damping / compliance**2 == pytest.approx(KNOWN.B_sp, rel=0.02)
    assert -friction / compliance == pytest.approx(held, rel=0.02)


def test_a_wedge_closes_at_no_torque_and_widens_with_it() -> None:
    """Gone round slowly forth and back, the branches lie as far apart as the torque is large."""
    effect, n = HystereticStiffness(), 8000
    torque = 40.0 * np.sin(np.linspace(0.0, 6 * np.pi, n))
    phi = torque / KNOWN.K
    s = dataclasses.replace(motion(n=n), torque=torque, theta_m=np.zeros(n), theta_l=-phi, gear=STRAIGHT)
    column = effect.columns(s, (1.5, effect.WEDGE))[Port.WIND_UP][:, 0]
    rising = np.gradient(torque) > 0
    late = np.arange(n) > n // 3

    def gap(at: float) -> float:
        near = late & (np.abs(torque - at) < 0.3)
        return float(column[near & rising].mean() - column[near & ~rising].mean())

    assert gap(20.0) == pytest.approx(2 * gap(10.0), rel=0.05)
    assert abs(gap(0.0)) < 0.05 * gap(20.0)
    fit = Fit(np.array([-1e-6]), (1.5, effect.WEDGE), np.eye(3), KNOWN, N)
    assert effect.plausible(fit)
    loss = effect.parameters(fit)[0]
    assert loss.name == "loss_at_20_Nm", "at no torque it has none"
    assert loss.value == pytest.approx(1e-6 * gap(effect.AT), rel=0.05)


@pytest.mark.parametrize(("half", "is_one"), [(0.5, True), (9.0, False)])
def test_a_resonance_is_one_whose_frequency_is_known(half: float, is_one: bool) -> None:
    found = Parameter("frequency", 40.0, (40.0 - half, 40.0 + half), "Hz")
    assert TorsionalMode().is_scaled(found, REACH) == is_one


@pytest.mark.parametrize(("inertia", "is_one"), [(0.5, True), (5.0, True), (40.0, False)])
def test_a_motor_keeps_a_rotor_of_its_own_beside_what_hangs_on_it(inertia: float, is_one: bool) -> None:
    """In times of what is left of J_m; lines of an encoder had made forty of it."""
    on_the_motor = Fit(np.array([inertia * KNOWN.J_m]), (1.0, 60.0, 0.03, 0.0), np.eye(5) * 1e-12, KNOWN, N)
    assert TorsionalMode().plausible(on_the_motor) is is_one


@pytest.mark.parametrize("several", [TOGETHER, SECTOR])
def test_orders_of_a_modulated_spring_together_are_those_of_each_alone(several: float) -> None:
    s, effect = motion(), AngleDependentStiffness()
    together = effect.columns(s, (several, 1.0, MOTOR))
    for port in (Port.WIND_UP, Port.MOTOR_TORQUE):
        alone = np.hstack([effect.columns(s, (k, 1.0, MOTOR))[port] for k in effect.SEVERAL[several]])
        np.testing.assert_array_equal(together[port], alone)


def test_the_largest_order_of_a_modulated_spring_is_told_first() -> None:
    effect = AngleDependentStiffness()
    sizes = np.array([0.01, 0.0, 0.0, 0.03, 0.0, 0.002]) / KNOWN.K
    names = [p.name for p in effect.parameters(Fit(sizes, (TOGETHER, 1.0, MOTOR), np.eye(9) * 1e-18, KNOWN, N))]
    assert names[::2] == ["kappa_order_2_amplitude", "kappa_order_1_amplitude", "kappa_order_4_amplitude"]


@pytest.mark.parametrize(("twice", "nothing"), [(0.4, False), (0.005, True)])
def test_crosstalk_that_is_felt_twice_a_turn_alone_is_not_nothing(twice: float, nothing: bool) -> None:
    """|cos θ_l|: no wave once a turn, one of 0.4 ± 0.02 N·m twice a turn."""
    effect = TorqueSensorCrosstalk()
    fit = Fit(np.array([0.0, 0.001, twice, 0.0]), (1.0, 2.0), 1e-4 * np.eye(6), KNOWN, 50.0)
    assert all(size.holds_zero for size in effect.sizes(effect.parameters(fit))) is nothing


def test_crosstalk_may_go_with_the_torque_or_with_its_size() -> None:
    effect, s = TorqueSensorCrosstalk(), motion()
    s = dataclasses.replace(s, torque=np.linspace(-40.0, 40.0, s.t.size))
    plain, signed, either = (effect.columns(s, (1.0, 2.0, kind))[Port.READS_TAU_L] for kind in (0.0, 1.0, 2.0))
    np.testing.assert_allclose(signed, plain * s.torque[:, None])
    np.testing.assert_allclose(either, plain * np.abs(s.torque)[:, None])


def test_drag_of_the_load_goes_with_the_speed_of_the_output_and_is_told_as_its_own() -> None:
    effect, s = QuadraticDrag(), motion()
    s = dataclasses.replace(s, omega_l=np.linspace(-0.4, 0.4, s.t.size))  # rad/s: the motor at 20 rad/s
    (column,) = effect.columns(s, (0.0, 2.0, 1.0))[Port.LOAD_TORQUE].T
    assert column[-1] == pytest.approx(4.0)  # times D at 10 rad/s of the motor
    assert column[0] == pytest.approx(-4.0)
    drag, exponent = effect.parameters(
        Fit(np.array([0.13]), (0.0, 2.0, 1.0), np.diag([1e-4, 0.0, 1e-2, 0.0]), KNOWN, N)
    )
    assert (drag.name, exponent.name) == ("drag_of_load_at_10_rad_s", "exponent")
    assert exponent.ci95[1] - exponent.value == pytest.approx(0.196, abs=1e-3)
    assert not effect.plausible(Fit(np.array([-0.1]), (0.0, 2.0, 1.0), np.eye(4), KNOWN, N))


def test_a_lag_too_short_for_the_rows_may_be_none() -> None:
    effect = LoadDependentKinematicError()
    for sure, least in ((0.0, 0.0), (1e-5, 1.8e-4 - 1.97e-5)):
        spread = np.zeros((5, 5))
        spread[3, 3] = sure**2
        fit = Fit(np.array([0.5]), (0.0, 3.0, 1.8e-4, 1.0), spread, KNOWN, 50.0)
        (lag,) = (p for p in effect.parameters(fit) if p.name == "lag")
        assert lag.ci95[0] == pytest.approx(least, abs=1e-6)
        assert lag.ci95[1] > lag.value


def test_friction_that_goes_with_a_logged_temperature_falls_by_e_over_its_scale() -> None:
    s = motion()
    scale, law = 40.0, ThermalFrictionDrift()
    (column,) = law.columns(s, (scale, LOGGED, law.BETA)).values()
    slope = np.gradient(column[:, 0] * s.way, s.temperature)[10:-10]
    at = s.temperature[10:-10]
    turning = np.abs(np.gradient(s.temperature))[10:-10] > 1e-4
    assert slope[turning] == pytest.approx(-np.exp(-(at[turning] - 20.0) / scale), rel=1e-3)
    unknown = dataclasses.replace(s, temperature=s.temperature * np.nan)
    (nothing,) = law.columns(unknown, (scale, LOGGED, law.BETA)).values()
    assert not nothing.any()


def test_only_a_campaign_with_a_temperature_is_asked_for_one() -> None:
    law = ThermalFrictionDrift()
    asked = {has: any(shape[1] == LOGGED for shape in law.shapes(dataclasses.replace(REACH, has=has))) for has in HAS}
    assert list(asked.values()) == [True, False]


HAS = (frozenset({"t", "theta_m", "temperature"}), frozenset({"t", "theta_m"}))


def test_the_papers_slow_run_is_long_enough_to_tell_an_order_of_the_flexspline_from_the_motors() -> None:
    """Of order 2.04 a third or more is no order 2 over ±1440°, a quarter over half of that, which is what a ratio of
    100 has of it, and too little over a quarter."""

    def apart(turns: float) -> float:
        theta = np.linspace(0.0, 2 * np.pi * N * turns, 4000)
        s = dataclasses.replace(motion(), theta_m=theta, theta_l=theta / N)
        waves = FlexsplineFrameError().columns(s, (2.0, 1.0, 0.0))[Port.KINEMATIC_ERROR]
        whole = np.column_stack([np.ones(theta.size), np.cos(2 * theta), np.sin(2 * theta)])
        left = waves - whole @ np.linalg.lstsq(whole, waves, rcond=None)[0]
        return float(np.std(left) / np.std(waves))

    for strokes, offered, least in ((2.0, True, 1 / 3), (1.0, True, 1 / 4), (0.5, False, 1 / 8)):
        turns = strokes * 1440 / 360 / N
        assert bool(FlexsplineFrameError().shapes(dataclasses.replace(REACH, load_turns=turns))) == offered
        assert least < apart(turns) < 2.0 * least


@pytest.mark.parametrize(("law", "by"), [(CLOCK, 2), (SOAK, 2), (HEAT, 4)])
def test_what_a_warm_up_takes_away_at_first_is_known_as_well_as_its_numbers_together(law: float, by: int) -> None:
    """Its interval, from the law's numbers one by one, beside finite differences."""
    effect, spread = ThermalFrictionDrift(), np.array([0.02, 1e-3, 80.0, 0.0, 2e-4])
    at = np.array([0.3, 2e-3, 700.0, law, 1e-3])

    def gone(x: Array) -> Parameter:
        fit = Fit(x[:2], tuple(x[2:]), np.diag(spread**2), KNOWN, N)
        return effect.parameters(fit)[-1]

    slopes = [
        (gone(at + h * np.eye(5)[i]).value - gone(at - h * np.eye(5)[i]).value) / (2 * h) if i in (0, 1, by) else 0.0
        for i, h in enumerate(1e-4 * at + 1e-12)
    ]
    half = (gone(at).ci95[1] - gone(at).ci95[0]) / 2
    assert half == pytest.approx(1.96 * float(np.linalg.norm(slopes * spread)), rel=1e-3)
    assert effect.sizes(effect.parameters(Fit(at[:2], tuple(at[2:]), np.eye(5), KNOWN, N)))[-1].name.startswith("gone")


@pytest.mark.parametrize(("wider", "open_"), [(3e-6, True), (9e-6, True), (2e-5, False)])
def test_a_gap_that_is_wider_at_some_angles_is_at_none_less_than_closed(wider: float, open_: bool) -> None:
    law = LostMotion()
    fit = Fit(np.array([8e-6, 0.0, 0.0, wider, 0.0]), (0.15, BY_ANGLE), 1e-14 * np.eye(6), KNOWN, N)
    assert law.plausible(fit) is open_


def test_what_rubs_may_ride_on_the_flexspline_where_the_output_turns_far_enough_to_tell() -> None:
    law = PositionDependentFriction()
    riding = {round(shape[0], 2) for shape in law.shapes(replace(REACH, load_turns=1.0))} - set(law.ORDERS)
    assert {2.04, 4.08, 1.96} <= riding
    assert {shape[0] for shape in law.shapes(replace(REACH, load_turns=0.05))} == {*law.ORDERS, *law.SHARP}
    one_way = replace(REACH, load_turns=0.05, backwards=0.0)  # what is not told from cogging is not sought
    assert {shape[0] for shape in law.shapes(one_way)} == set(law.ORDERS)
    s = motion()
    (columns,) = law.columns(s, (2.0 * (1 + 1 / N),)).values()
    lobes = np.cos(2.0 * (s.theta_m + s.theta_m / N)) * s.way
    np.testing.assert_allclose(columns[:, 0], lobes, atol=1e-9)
