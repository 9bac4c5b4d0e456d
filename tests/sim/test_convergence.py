"""The substeps are short enough: against an independent integrator, and against themselves made finer."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

from sim.parameters import TwinParameters
from sim.plant import Plant
from tests.sim.reference import forces, sliding
from tests.some import some

Array = npt.NDArray[np.float64]
TICK = 1e-3  # s
COUNT = 7e-6  # rad, one count of the load encoder
RESOLUTION = 1.5e-3  # N·m, of the torque sensor


def observe(plant: Plant, torques: Array) -> Array:
    """Rows (θ_m/N − θ_l, τ_l), one a tick."""
    rows, ratio = [], plant.parameters.gear.ratio
    for tau in torques:
        plant.advance(TICK, float(tau))
        x = plant.truth()
        rows.append((x.theta_m / ratio - x.theta_l, x.tau_l))
    return np.array(rows)


def torque_at(rpm: float) -> float:
    """A little more than holds that speed, so that no side stops; the drive has to rise to it from zero."""
    return 0.34 + 3.3e-3 * rpm * math.pi / 30


def independent(parameters: TwinParameters, rpm: float, n: int) -> Array:
    """The same rows from DOP853 and the Lagrangian's forces."""
    plant, gear = Plant(parameters), parameters.gear
    plant.place(0.3, rpm * math.pi / 30)
    x = plant.truth()
    tau, times = torque_at(rpm), TICK * np.arange(1, n + 1)
    start = np.array([x.theta_m, x.theta_l, x.omega_m, x.omega_l])
    states = sliding(gear, start, times, tau, -tau, parameters.tau_drive)
    tau_l = [forces(gear, s[:2], s[2:], (0.0, 0.0))[1] + gear.B_l * s[3] for s in states]
    return np.column_stack([states[:, 0] / gear.ratio - states[:, 1], tau_l])


@pytest.mark.slow
@pytest.mark.parametrize("rpm", some([9.6, 120.0, 300.0, 500.0], 2))
def test_smooth_turning_is_exact_far_below_a_count_and_converges(calm: TwinParameters, rpm: float) -> None:
    expected = independent(calm, rpm, 400)
    errors = []
    for refine in (1.0, 4.0):
        plant = Plant(calm, refine=refine)
        plant.place(0.3, rpm * math.pi / 30)
        errors.append(np.abs(observe(plant, np.full(400, torque_at(rpm))) - expected).max(axis=0))
    assert errors[0][0] < 3e-8
    assert errors[0][0] < COUNT / 100
    assert errors[0][1] < RESOLUTION / 5
    assert np.all(errors[1] < errors[0] / 50)  # fourth order: 256 times, while rounding is far


REVERSALS = {
    "both sides through rest": lambda t: 0.9 * np.sin(2 * np.pi * 2.0 * t) + 0.3 * np.sin(2 * np.pi * 7.3 * t),
    "stick and slip": lambda t: 0.55 * np.sin(2 * np.pi * 1.3 * t),
}


@pytest.mark.parametrize("name", REVERSALS)
def test_reversals_with_sticking_converge(calm: TwinParameters, name: str) -> None:
    torques = REVERSALS[name](TICK * np.arange(2000))
    fine = observe(Plant(calm, theta_m=0.3, refine=32.0), torques)
    errors = [np.abs(observe(Plant(calm, theta_m=0.3, refine=r), torques) - fine).max(axis=0) for r in (1.0, 4.0)]
    assert errors[0][0] < COUNT / 30
    assert errors[0][1] < RESOLUTION
    assert np.all(errors[1] < errors[0] / 20)


def test_many_short_calls_and_one_long_call_agree(calm: TwinParameters) -> None:
    often, once = Plant(calm, theta_m=0.3, refine=4.0), Plant(calm, theta_m=0.3, refine=4.0)
    for _ in range(100):
        often.advance(TICK, 0.6)
    once.advance(0.1, 0.6)
    np.testing.assert_allclose(often.truth(), once.truth(), rtol=1e-6, atol=1e-9)
