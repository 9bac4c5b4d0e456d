"""Many gears at once move as each of them does by itself, through standstill and reversal, or not at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from rig.bench import read, twin_parameters
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear
from rig.model.simulate import Start, each_under_torque, under_torque

Array = npt.NDArray[np.float64]
pytestmark = pytest.mark.slow  # compiles for some seconds where nothing is cached


@pytest.fixture(scope="module")
def gears() -> list[Gear]:
    """Forty: a block and part of another, no two alike, one with a shorter series."""
    base = twin_parameters(read("twin").file).gear
    x = np.linspace(0.9, 1.1, 40).tolist()
    found = [
        replace(base, K=base.K * a, J_l=base.J_l * b, tau_c=base.tau_c * a) for a, b in zip(x, x[::-1], strict=True)
    ]
    short = FourierSeries(base.kinematic_error.a[:3], base.kinematic_error.b[:3])
    return [*found[:7], replace(found[7], kinematic_error=short), *found[8:]]


def apart(gears: list[Gear], t: Array, tau: Array, start: Array, which: int) -> tuple[float, float]:
    """Largest difference [rad] of θ_m and of θ_l from what `under_torque` says of that gear."""
    swept = each_under_torque(gears, t, tau, start=start)
    fine = np.unique(np.concatenate([t, np.arange(t[0], t[-1], 1e-3)]))
    held = tau[np.searchsorted(t, fine, side="right") - 1]
    alone = under_torque(gears[which], fine, held, start=Start(*map(float, start[:, which])))
    at = np.searchsorted(fine, t)
    return (
        float(np.max(np.abs(swept.theta_m[which] - alone.theta_m[at]))),
        float(np.max(np.abs(swept.theta_l[which] - alone.theta_l[at]))),
    )


@pytest.mark.parametrize("which", [0, 7, 31, 39])
def test_while_it_slides_each_gear_moves_as_by_itself(gears: list[Gear], which: int) -> None:
    """10 rad/s and faster for half a second, five torques; a count of the load encoder is 7e-6 rad."""
    start = np.tile(np.array([[0.3], [10.0], [0.006], [0.2]]), (1, len(gears)))
    t, tau = np.linspace(0.0, 0.5, 6), np.array([0.45, 0.6, 0.5, 0.8, 0.4, 0.4])
    of_motor, of_load = apart(gears, t, tau, start, which)
    assert of_motor < 2e-6  # rad at the motor, of some 20 turned
    assert of_load < 5e-8


@pytest.mark.parametrize("which", [0, 39])
def test_through_breakaway_rest_and_reversal_too(gears: list[Gear], which: int) -> None:
    """A reversal begins up to 50 µs late: at 600 rad/s² the motor is then 0.03 rad/s behind for the last 0.4 s."""
    start = np.tile(np.array([[0.3], [0.0], [0.006], [0.0]]), (1, len(gears)))
    t, tau = np.linspace(0.0, 1.0, 6), np.array([0.2, 0.9, 0.0, -0.9, 0.0, 0.0])
    of_motor, of_load = apart(gears, t, tau, start, which)
    assert of_motor < 600 * 5e-5 * 0.4  # rad, of 20 turned
    assert of_load < 600 * 5e-5 * 0.4 / 50


def test_a_gear_at_rest_stays_where_friction_holds_it(gears: list[Gear]) -> None:
    swept = each_under_torque(gears, np.array([0.0, 0.1, 0.2]), np.full(3, 0.5 * gears[0].tau_s))
    assert np.all(swept.omega_m == 0.0)
    assert np.all(swept.theta_m == 0.0)


def test_a_gear_that_runs_away_is_no_number_and_its_neighbours_do_not_mind(gears: list[Gear]) -> None:
    """Never a finite wrong answer: drag that feeds the motion doubles the speed within a substep."""
    mad = [*gears[:3], replace(gears[3], B_m=-20.0, B_ml=0.0), *gears[4:]]
    start = np.tile(np.array([[0.0], [10.0], [0.0], [0.2]]), (1, len(gears)))
    t, tau = np.array([0.0, 0.05]), np.full(2, 0.45)
    swept = each_under_torque(mad, t, tau, start=start)
    assert np.isnan(swept.theta_m[3, -1])
    assert np.isfinite(np.delete(swept.theta_m, 3, axis=0)).all()
    calm = each_under_torque(gears, t, tau, start=start)
    assert np.max(np.abs(np.delete(swept.theta_m - calm.theta_m, 3, axis=0))) < 1e-6
