"""What a torque that nothing corrects does, predicted: against the equation of motion, against the twin."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rig.bench import read
from tests.fakes import DRIVETRAIN, SETTING

J = DRIVETRAIN.J_m + DRIVETRAIN.J_l


@pytest.mark.parametrize("B", [DRIVETRAIN.B, 0.0])
@pytest.mark.parametrize(("tau", "seconds", "before"), [(1.25, 0.06, 0.0), (0.5, 2.0, 30.0), (0.2, 0.02, 30.0)])
def test_the_speed_is_that_of_one_inertia_with_friction_and_drag(
    B: float, tau: float, seconds: float, before: float
) -> None:
    told = replace(DRIVETRAIN, B=B).speed_after(tau, seconds, before)
    solved = solve_ivp(lambda _, w: (tau - DRIVETRAIN.tau_c - B * w) / J, (0.0, seconds), [before], rtol=1e-8)
    assert told == pytest.approx(solved.y[0, -1], rel=1e-6)


def test_a_torque_below_friction_brings_it_to_rest_and_no_further() -> None:
    assert DRIVETRAIN.speed_after(0.2, 10.0, 30.0) == 0.0


@pytest.mark.parametrize("seconds", [0.01, 0.025, 0.06])
def test_a_step_on_two_inertias_stays_within_what_is_told(seconds: float) -> None:
    free = replace(DRIVETRAIN, B=0.0, tau_c=0.0)
    k = free.omega_n**2 * free.J_m * free.J_l / J  # at the motor

    def rates(_: float, x: np.ndarray) -> list[float]:
        twist = k * (x[0] - x[1])
        return [x[2], x[3], (2.0 - twist) / free.J_m, twist / free.J_l]

    t = np.linspace(0.0, seconds, 400)
    x = solve_ivp(rates, (0.0, seconds), [0.0] * 4, t_eval=t, rtol=1e-8, atol=1e-10).y
    assert x[2].max() <= free.step_speed(2.0, seconds)
    assert free.ratio * k * np.abs(x[0] - x[1]).max() <= free.step_shaft_torque(2.0, 1.0)


def test_the_bench_file_is_seen_from_the_motor() -> None:
    found = read("twin").drivetrain
    assert found.J_l == pytest.approx(0.32 / 2500)
    assert pytest.approx(5.0e-4 + 2.5e-3 * 1.02**2 + 0.5 / 2500) == found.B
    assert found.tau_c == 0.32
    assert SETTING.drivetrain.J_l == found.J_l
