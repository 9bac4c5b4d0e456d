"""The world: time passes only when someone waits, and what was planned happens on the way."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from rig.core.errors import UsageError
from sim import kernel
from sim.noise import normal
from sim.parameters import TwinParameters
from sim.plant import PlantFailure
from sim.world import CREEPING, World


def test_time_stands_still_until_someone_waits(twin: TwinParameters) -> None:
    world = World(twin, 1)
    before = world.truth()
    time.sleep(0.01)
    assert world.now() == 0.0
    assert world.truth() == before


def test_waiting_returns_at_the_time_asked_for_and_never_goes_back(twin: TwinParameters) -> None:
    world = World(twin, 1)
    assert world.wait_until(0.25) == 0.25
    assert world.wait_until(0.1) == 0.25
    assert world.wait_until(math.nan) == 0.25
    world.advance_to(0.2)
    assert world.now() == 0.25


def test_relax_holds_rig_time_and_lets_wall_time_pass(twin: TwinParameters) -> None:
    world, begin = World(twin, 1), time.monotonic()
    assert world.relax() is True
    assert world.now() == 0.0
    assert time.monotonic() - begin >= 0.001


def test_the_rig_starts_at_rest_with_its_spring_relaxed_at_an_angle_of_its_own(twin: TwinParameters) -> None:
    starts = [World(twin, seed).truth() for seed in range(8)]
    for x in starts:
        assert (x.omega_m, x.omega_l, x.tau_m) == (0.0, 0.0, 0.0)
        assert x.phi == pytest.approx(0.0, abs=1e-15)
        assert x.tau_l == pytest.approx(0.0, abs=1e-11)
    assert np.ptp([x.theta_m % (2 * math.pi) for x in starts]) > 2.0
    assert np.ptp([x.theta_l for x in starts]) > 2.0


def test_the_motor_torque_follows_through_the_first_order_loop(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.command(0.4)
    world.wait_until(twin.tau_drive)
    assert world.truth().tau_m == pytest.approx(0.4 * (1 - math.exp(-1)), rel=1e-12)


def test_a_command_lapses_at_its_time_also_inside_one_long_wait(twin: TwinParameters) -> None:
    world, lapses = World(twin, 1), []
    world.command(0.4, 0.0205, lambda: lapses.append(world.now()))
    world.wait_until(1.0)
    assert lapses == [0.0205]
    assert world.truth().tau_m == 0.0 or world.truth().tau_m < 1e-300


def test_a_renewed_command_does_not_lapse(twin: TwinParameters) -> None:
    world, lapses = World(twin, 1), []
    for k in range(100):
        world.command(0.1, world.now() + 0.02, lambda: lapses.append(world.now()))
        world.wait_until((k + 1) * 0.01)
    assert lapses == []


def test_plans_happen_in_order_at_their_times(twin: TwinParameters) -> None:
    world, seen = World(twin, 1), []
    world.at(0.3, lambda: seen.append(("b", world.now())))
    world.at(0.1, lambda: seen.append(("a", world.now())))
    world.at(0.3, lambda: seen.append(("c", world.now())))
    world.command(0.0, 0.2, lambda: seen.append(("lapse", world.now())))
    world.wait_until(0.25)
    assert seen == [("a", 0.1), ("lapse", 0.2)]
    world.wait_until(1.0)
    assert seen[2:] == [("b", 0.3), ("c", 0.3)]


def test_a_plan_for_the_past_happens_at_once(twin: TwinParameters) -> None:
    world, seen = World(twin, 1), []
    world.wait_until(1.0)
    world.at(0.5, lambda: seen.append(world.now()))
    world.wait_until(1.001)
    assert seen == [1.0]


def test_a_plan_may_make_another(twin: TwinParameters) -> None:
    world, seen = World(twin, 1), []
    world.at(0.1, lambda: world.at(0.2, lambda: seen.append(world.now())))
    world.wait_until(0.15)
    world.wait_until(0.3)
    assert seen == [0.2]


def test_a_dead_weight_and_a_locked_output_act_on_the_load(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.lock_output()
    world.load_torque(20.0)
    held = world.truth()
    world.wait_until(0.5)
    assert world.truth().theta_l == held.theta_l
    world.unlock_output()
    world.wait_until(0.55)
    assert world.truth().theta_l > held.theta_l


def test_a_weight_that_no_gear_survives_is_refused(twin: TwinParameters) -> None:
    with pytest.raises(UsageError, match="a weight of 1e\\+09 N·m: expected a number from -1000 to 1000 N·m"):
        World(twin, 1).load_torque(1e9)


def test_an_output_that_only_creeps_is_held_where_it_is(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.load_torque(20.0)
    while world.truth().omega_l == 0.0:
        world.wait_until(world.now() + 1e-6)
    assert 0.0 < world.truth().omega_l < CREEPING
    world.lock_output()
    assert world.truth().omega_l == 0.0


def test_a_turning_output_cannot_be_locked(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.load_torque(20.0)
    world.wait_until(0.005)
    with pytest.raises(UsageError, match="it can be locked at rest only"):
        world.lock_output()


def test_friction_wanders_on_during_one_long_wait(twin: TwinParameters) -> None:
    world, single = World(twin, 1), normal(1, "friction")
    world.wait_until(60.0)
    wander = world.plant.state[kernel.WANDER_M]
    assert 0.0 < abs(wander) < 6 * twin.friction_noise
    assert wander != pytest.approx(twin.friction_noise * single(), rel=1e-3)  # what one draw for it all would give


def test_a_plant_that_fails_stops_time(twin: TwinParameters) -> None:
    world = World(twin, 1)
    world.wait_until(0.5)
    world.command(math.nan)
    with pytest.raises(PlantFailure):
        world.wait_until(0.6)
    assert world.now() == 0.5
