"""From rest under one torque: a gear runs up as its inertia and drag say, or stays where friction holds it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.bench import read, twin_parameters
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.simulate.run_up import RunUp, run_up

pytestmark = pytest.mark.slow  # compiles for some seconds where nothing is cached
TAU = 0.6  # N·m


@pytest.fixture(scope="module")
def gear() -> Gear:
    return twin_parameters(read("twin").file).gear


def smooth(gear: Gear) -> Gear:
    """Without kinematic error, and stiff enough to turn as one piece."""
    return replace(gear, kinematic_error=FourierSeries((0.0,), (0.0,)), K=10 * gear.K)


def drag(gear: Gear) -> float:
    """Of all that turns, N·m·s/rad at the motor."""
    return gear.B_m + gear.B_ml * (1 + gear.sigma / gear.ratio) ** 2 + gear.B_l / gear.ratio**2


def test_speed_and_time_are_those_of_one_inertia_with_drag(gear: Gear) -> None:
    plain = smooth(gear)
    made = run_up([plain], TAU, 5.0)
    T = (plain.J_m + plain.J_l / plain.ratio**2) / drag(plain)
    end = (TAU - plain.tau_c - plain.F_cl / plain.ratio) / drag(plain)
    assert made.speed[0] == pytest.approx(end, rel=1e-3)
    assert made.time[0] == pytest.approx(-T * np.log(0.05), rel=0.02)


def test_a_torque_between_sliding_and_breakaway_does_not_start_a_gear(gear: Gear) -> None:
    between = 0.5 * (gear.tau_c + gear.tau_s)
    made = run_up([gear, replace(gear, tau_s=gear.tau_c)], between, 5.0)
    assert made.turning.tolist() == [False, True]
    assert np.isnan(made.time[0])
    assert made.moved[0] < 0.01


def test_backwards_is_the_same_with_the_other_sign(gear: Gear) -> None:
    plain = smooth(gear)
    there, back = run_up([plain], TAU, 3.0), run_up([plain], -TAU, 3.0)
    assert back.speed[0] == pytest.approx(-there.speed[0], rel=1e-6)
    assert back.time[0] == pytest.approx(there.time[0], rel=1e-4)


def test_the_time_of_an_exponential_is_where_it_reaches_95_percent() -> None:
    t, T = np.linspace(0.0, 5.0, 501), 0.4
    made = RunUp(t, 50.0 * (t - T * (1 - np.exp(-t / T)))[None, :])
    assert made.time[0] == pytest.approx(-T * np.log(0.05), rel=1e-3)
    assert made.speed[0] == pytest.approx(50.0, rel=1e-3)
