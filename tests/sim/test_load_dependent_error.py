"""Kinematic error by load and by depth of assembly, as the paper's Figs. 9 and 10 have it."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from rig.core.errors import UsageError
from sim import kernel
from sim.effects import Assembly, Effects, LoadDependentError
from sim.parameters import TwinParameters
from sim.plant import Plant
from sim.world import World
from tests.sim.conftest import FRICTIONLESS, with_gear

TICK = 1e-3  # s
LAW = LoadDependentError(A_inf=0.55, T_c=2.5, filter=0.5)
DEEP = Assembly(error_per_mm=0.8, friction_per_mm=0.3)


def having(parameters: TwinParameters, depth_mm: float = 0.0) -> TwinParameters:
    depth = dataclasses.replace(DEEP, depth_mm=depth_mm)
    return dataclasses.replace(parameters, effects=Effects(load_dependent_error=LAW, assembly=depth))


def measured(parameters: TwinParameters, load: float) -> float:
    """Amplitude of order 2 [rad] seen at 60 rpm under `load` N·m, after the filter has settled."""
    plant, ratio, rows = Plant(with_gear(parameters, J_l=0.01, **FRICTIONLESS)), parameters.gear.ratio, []
    plant.place(0.0, 2 * math.pi)
    plant.tau_ext = -load
    for k in range(8000):
        plant.advance(TICK, 0.3 * (2 * math.pi - plant.motor[1]) + load / ratio + 0.02)
        x = plant.truth()
        if k >= 5000:
            rows.append((x.theta_m, x.theta_m / ratio - x.theta_l))
    theta, error = np.array(rows).T
    n = np.arange(1, 16)
    columns = [np.ones_like(theta), *np.cos(np.outer(n, theta)), *np.sin(np.outer(n, theta))]
    fit = np.linalg.lstsq(np.array(columns).T, error, rcond=None)[0]
    return float(np.hypot(fit[2], fit[17]))


@pytest.mark.slow
def test_the_error_falls_with_load_to_its_plateau(calm: TwinParameters) -> None:
    c2 = float(calm.gear.kinematic_error.amplitude[1])
    shares = [measured(having(calm), load) / c2 for load in (0.0, 2.5, 7.5, 15.0)]
    expected = [LAW.A_inf + (1 - LAW.A_inf) * math.exp(-load / LAW.T_c) for load in (0.0, 2.5, 7.5, 15.0)]
    np.testing.assert_allclose(shares, expected, atol=0.015)  # the drag of a few hundredths of N·m is load as well
    assert shares[2] == pytest.approx(LAW.A_inf, abs=0.03)  # flat from 7.5 N·m on


def test_load_of_either_sign_counts(calm: TwinParameters) -> None:
    assert measured(having(calm), 5.0) == pytest.approx(measured(having(calm), -5.0), rel=0.02)


@pytest.mark.slow
def test_deeper_the_error_is_smaller_at_no_load_with_the_same_plateau_and_a_harder_start(calm: TwinParameters) -> None:
    flat, deep = having(calm), having(calm, 0.3)
    assert measured(deep, 0.0) / measured(flat, 0.0) == pytest.approx(1 - 0.8 * 0.3, abs=0.02)
    assert measured(deep, 15.0) == pytest.approx(measured(flat, 15.0), rel=0.01)
    assert measured(deep, 0.0) - measured(deep, 2.5) < measured(flat, 0.0) - measured(flat, 2.5)
    starts = []
    for parameters in (flat, deep):
        plant, tau = Plant(parameters), 0.0
        while plant.motor[1] == 0.0:
            tau += 1e-3
            plant.advance(0.01, tau)
        starts.append(tau)
    assert starts[0] == pytest.approx(calm.gear.tau_s, abs=2e-3)
    assert starts[1] == pytest.approx(calm.gear.tau_s * 1.09, abs=2e-3)


def test_the_filter_follows_the_spring_with_its_time_constant(calm: TwinParameters) -> None:
    plant = Plant(with_gear(having(calm), F_cl=0.0, tau_s=9.0, tau_c=9.0, B_l=30.0))
    plant.tau_ext = 7.0
    for _ in range(6000):
        plant.advance(TICK, 0.0)
    assert plant.state[kernel.LOAD_SEEN] == pytest.approx(7.0, rel=1e-3)
    plant.tau_ext = 0.0
    for _ in range(500):
        plant.advance(TICK, 0.0)
    assert plant.state[kernel.LOAD_SEEN] == pytest.approx(7.0 * math.exp(-1), rel=0.1)  # the load swings out first


def chances(twin: TwinParameters) -> TwinParameters:
    law = Assembly(scatter=0.2, scatter_deg=20.0)
    return dataclasses.replace(twin, effects=Effects(load_dependent_error=LAW, assembly=law))


def test_each_assembly_draws_its_own_error_from_the_seed(twin: TwinParameters) -> None:
    def drawn(seed: int) -> np.ndarray:
        world, found = World(chances(twin), seed), []
        for _ in range(40):
            world.reassemble(0.0)
            found.append(world.parameters.gear.kinematic_error.amplitude)
        return np.array(found) / twin.gear.kinematic_error.amplitude

    once, again, other = drawn(1), drawn(1), drawn(2)
    assert np.array_equal(once, again)
    assert not np.allclose(once, other)
    assert np.std(once) == pytest.approx(0.2, rel=0.1)
    assert np.mean(once) == pytest.approx(1.0, abs=0.03)  # around the gear as made, not around the last assembly


def test_reassembly_keeps_motor_angle_time_and_devices_and_relaxes_the_spring(twin: TwinParameters) -> None:
    world = World(chances(twin), 1)
    world.wait_until(0.5)
    before = world.truth()
    world.reassemble(0.25)
    after = world.truth()
    assert after.theta_m == before.theta_m
    assert after.theta_l == pytest.approx(before.theta_l, abs=3e-4)
    assert after.phi == pytest.approx(0.0, abs=1e-15)
    assert world.now() == 0.5
    assert world.parameters.effects.assembly.depth_mm == 0.25
    assert world.plant.parameters is world.parameters
    world.wait_until(1.0)


def test_a_turning_gear_cannot_be_reassembled(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.command(1.5)
    world.wait_until(0.1)
    with pytest.raises(UsageError, match="can be reassembled at rest only"):
        world.reassemble(0.0)
