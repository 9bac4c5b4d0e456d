"""The free simulation of the tracer against the library's own, and its effects against what they are by hand."""

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.led import Model
from rig.analysis.tracing.outcome.replay import Anderson, _kinematic_error
from rig.model.effect import Known, Signals
from rig.model.effects import CATALOGUE
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.simulate import under_motion

N, DT = 50.0, 0.004
SERIES = FourierSeries((0.0, 2e-4, 0.0, 5e-5), (0.0, 1e-4, 0.0, 0.0))
KNOWN = Known(K=7160.0, B_sp=6.0, J_m=1.5e-3, J_l=0.8, kinematic_error=SERIES)
START = 500  # rows, 2 s: eight time constants of the resonance


def turning(rpm: float, n: int = 1500, tau_ext: float = 0.0) -> Signals:
    """A motor that turns evenly."""
    t, nothing = np.arange(n) * DT, np.zeros(n)
    omega = rpm * np.pi / 30
    theta = omega * t
    return Signals(
        t=t, dt=DT, ratio=N, theta_m=theta, theta_l=theta / N, omega_m=np.full(n, omega), alpha_m=nothing,
        omega_l=np.full(n, omega / N), alpha_l=nothing, torque=nothing, torque_rate=nothing,
        tau_m=nothing, tau_l=nothing, tau_ext=np.full(n, tau_ext), way=np.ones(n), temperature=nothing, gear=KNOWN,
    )  # fmt: skip


@pytest.mark.parametrize("rpm", [60.0, 300.0, 430.0])
def test_without_effects_it_is_the_motion_of_the_papers_equations(rpm: float):
    s = turning(rpm, tau_ext=-5.0)
    found = _kinematic_error(s, Model(KNOWN, B_l=1.0, tau_cl=0.4, mesh=0.0, terms=()))
    gear = Gear(N, 1.5e-3, 0.8, 7160.0, 0.0, 1.0, 0.0, 6.0, SERIES, F_cl=0.4)
    wanted = s.theta_m / N - under_motion(gear, s.t, s.theta_m, tau_ext=-5.0)
    assert found is not None
    np.testing.assert_allclose(found[START:], wanted[START:], atol=2e-7)


def test_a_gap_of_lost_motion_shifts_the_load_and_keeps_its_shape_under_steady_load():
    s = turning(60.0, tau_ext=-20.0)
    effect = CATALOGUE["lost_motion"]
    shape = effect.shapes(_reach())[0]
    terms = ((Term(effect, shape), np.array([1e-4])),)
    with_gap, without = (_kinematic_error(s, Model(KNOWN, 1.0, 0.4, 0.0, t)) for t in (terms, ()))
    assert with_gap is not None
    assert without is not None
    column = next(iter(effect.columns(_under(s, 20.0), shape).values()))
    np.testing.assert_allclose((with_gap - without)[START:].mean(), 1e-4 * column.mean(), rtol=0.02)


def test_an_angle_read_late_is_late_in_the_simulation():
    s = turning(300.0)
    late = ((Term(CATALOGUE["channel_time_skew"], (0.0, 0.0, 0.0)), np.array([5e-4])),)
    found, plain = (_kinematic_error(s, Model(KNOWN, 1.0, 0.4, 0.0, t)) for t in (late, ()))
    assert found is not None
    assert plain is not None
    assert (found - plain)[START:].mean() == pytest.approx(5e-4 * s.omega_l[0], rel=1e-3)


def test_a_motor_read_by_an_eccentric_encoder_is_led_as_it_turned_and_not_as_it_was_read():
    """It was believed settled before the motor had been led without the reading's error (exam 104, case 13)."""
    even = turning(300.0)
    too_much = 4e-3 * np.cos(even.theta_m)
    read = replace(even, theta_m=even.theta_m + too_much)
    effect = CATALOGUE["motor_encoder_eccentricity"]
    terms = ((Term(effect, ()), 4e-3 * np.eye(2 * effect.ORDERS)[0]),)
    found = _kinematic_error(read, Model(KNOWN, 1.0, 0.4, 0.0, terms))
    plain = _kinematic_error(even, Model(KNOWN, 1.0, 0.4, 0.0, ()))
    assert found is not None
    assert plain is not None
    np.testing.assert_allclose((found - plain)[START:], too_much[START:] / N, atol=2e-6)


def test_a_state_follows_the_simulated_motion_not_the_measured_one_a_part_was_cut_from():
    s = turning(300.0, tau_ext=-20.0)
    effect = CATALOGUE["load_dependent_kinematic_error"]
    terms = ((Term(effect, (0.0, 6.0, 3e-3, 1.0)), np.array([2.0])),)
    plain, whole, part = (
        _kinematic_error(of, Model(KNOWN, 1.0, 0.4, 0.0, t))
        for of, t in ((s, ()), (s, terms), (s.part(slice(0, s.t.size)), terms))
    )
    assert plain is not None
    assert whole is not None
    assert part is not None
    assert np.std((whole - plain)[START:]) > 1e-6
    np.testing.assert_array_equal(part, whole)


def test_the_fixed_point_of_a_map_that_overshoots_is_found():
    rng = np.random.default_rng(0)
    matrix = -0.9 * np.eye(20) + 0.5 * rng.standard_normal((20, 20)) / np.sqrt(20)
    wanted = rng.standard_normal(20)
    mixed, x = Anderson(), np.zeros(20)
    for _ in range(60):
        x = mixed.next(x, wanted + matrix @ (x - wanted))
    np.testing.assert_allclose(x, wanted, atol=1e-6)


def _under(s: Signals, torque: float) -> Signals:
    from dataclasses import replace

    return replace(s, torque=np.full(s.t.size, torque), tau_l=np.full(s.t.size, torque))


def _reach():
    from rig.model.effect import Reach

    return Reach(N, 45.0, 1.0, 40.0, 2700.0, 1000.0, 72.0, 1.0, 65536, 1_296_000)
