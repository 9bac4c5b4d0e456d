"""Whether a loop swings up by itself, held against the loop itself turning a gear without friction."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rig.control.filter import SpeedFilter
from rig.control.pid import Pid
from rig.control.stability import GROWS, MOST, Loop
from rig.core.drivetrain import Drivetrain
from rig.core.gains import Gains

GAINS = Gains(Kp=3.0, Ki=30.0, Kd=0.12, integrator_limit=1e9, torque_limit=1e9)
GEAR = Drivetrain(J_m=1.1e-3, J_l=1.28e-4, B=3.3e-3, tau_c=0.0, omega_n=158.0, zeta=0.04, ratio=50.0)
T, FILTER = 0.001, 0.008
LOOP = Loop(GEAR, T, FILTER)


def swing(gains: Gains, seconds: float) -> float:
    """How much larger the motor's swing is after `seconds` than half of them after a push, by the PID as it runs and
    an integrator of its own; 1 where it is the same."""
    reduced = GEAR.J_m * GEAR.J_l / (GEAR.J_m + GEAR.J_l)
    k, c = reduced * GEAR.omega_n**2, 2 * GEAR.zeta * GEAR.omega_n * reduced

    def rates(t: float, x: np.ndarray, tau: float) -> list[float]:
        theta, omega, theta_l, omega_l = x
        shaft = k * (theta - theta_l) + c * (omega - omega_l)
        return [omega, (tau - shaft - GEAR.B * omega) / GEAR.J_m, omega_l, shaft / GEAR.J_l]

    pid, speed, x, waiting, seen = Pid(gains, T), SpeedFilter(FILTER), np.array([0.0, 0.01, 0.0, 0.0]), 0.0, []
    for tick in range(round(seconds / T)):
        torque = pid.step(0.0, 0.0, x[0], speed.step(tick * T, x[0]))
        x = solve_ivp(rates, (0.0, T), x, args=(waiting,), rtol=1e-8, atol=1e-12).y[:, -1]
        waiting = torque
        seen.append(abs(x[0]))
    half = len(seen) // 2
    return float(max(seen[half:]) / max(seen[:half]))


@pytest.mark.parametrize(("Kp", "grows"), [(3.0, False), (15.0, False), (60.0, True)])
def test_what_swings_up_is_what_the_loop_itself_makes_grow(Kp: float, grows: bool) -> None:
    gains = replace(GAINS, Kp=Kp)
    assert (LOOP.growth(gains) > GROWS) is grows
    assert (swing(gains, 0.4) > 1.0) is grows


def test_the_growth_is_how_fast_a_swing_of_the_loop_itself_grows() -> None:
    gains = replace(GAINS, Kp=100.0)
    assert np.log(swing(gains, 0.4)) / 0.2 == pytest.approx(LOOP.growth(gains), rel=0.05)


def test_the_margin_is_what_the_gains_may_be_multiplied_by() -> None:
    margin = LOOP.margin(GAINS)
    assert 2.0 < margin < 10.0
    assert LOOP.growth(GAINS, margin) > GROWS > LOOP.growth(GAINS, 0.9 * margin)
    assert LOOP.margin(replace(GAINS, Kp=1e9)) == 1.0
    assert LOOP.margin(replace(GAINS, Kp=1e-6, Ki=0.0, Kd=1e-6)) == MOST


@pytest.mark.parametrize("Kp", [1e100, 1.7e308])
@pytest.mark.parametrize("Kd", [0.12, 1.7e308])
def test_gains_beyond_any_number_swing_up_as_well(Kp: float, Kd: float) -> None:
    assert LOOP.swings_up(replace(GAINS, Kp=Kp, Kd=Kd))
    assert not LOOP.swings_up(GAINS)
