"""The compiled kernel and the same source as plain Python; failures that are loud; runs that repeat to the bit."""

from __future__ import annotations

import dataclasses
import math
from types import ModuleType

import numpy as np
import pytest

from rig.core.errors import UsageError
from sim import kernel
from sim.parameters import TwinParameters
from sim.plant import Plant, PlantFailure
from sim.vector import pack
from sim.world import World
from tests.sim.conftest import with_gear
from tests.sim.everything import EVERYTHING


@pytest.mark.slow
def test_compiled_and_plain_python_agree(plain: ModuleType, twin: TwinParameters) -> None:
    assert not hasattr(plain.advance, "py_func")  # nothing compiled in it
    assert not hasattr(plain.entries.__globals__["substeps"], "py_func")
    agree(plain, twin)


@pytest.mark.slow
def test_compiled_and_plain_python_agree_on_everything_the_papers_model_lacks(
    plain: ModuleType, twin: TwinParameters
) -> None:
    agree(plain, dataclasses.replace(twin, effects=EVERYTHING), "advance_full", ticks=500, kinds=5)


def agree(
    plain: ModuleType, parameters: TwinParameters, name: str = "advance", ticks: int = 1500, kinds: int = 7
) -> None:
    """So many ms of reversals, sticking on either side, the same in both."""
    vectors = {key: pack(parameters, 1.0) for key in ("compiled", "plain")}
    start, rng = Plant(parameters, theta_m=3.0).state, np.random.default_rng(7)
    states, events = {key: start.copy() for key in vectors}, set()
    for k in range(ticks):
        tau = 1.2 * math.sin(k / 60) + 0.3 * math.sin(k / 7)
        tau_ext, xi = 2.0 * math.sin(k / 200), rng.standard_normal(2).tolist()
        ends = [
            getattr(module, name)(states[key], vectors[key], 1e-3, tau, tau_ext, False, *xi)
            for key, module in (("compiled", kernel), ("plain", plain))
        ]
        assert ends[0][0] == ends[1][0] == kernel.FINE
        np.testing.assert_allclose(states["compiled"], states["plain"], rtol=1e-9, atol=1e-12)
        for ours, theirs in zip(ends[0][1:], ends[1][1:], strict=True):
            np.testing.assert_allclose(ours, theirs, rtol=1e-7, atol=1e-7)
        events.add((np.sign(ends[0][1][1]), np.sign(ends[0][2][1])))
    assert len(events) >= kinds  # of nine: forward, back and at rest on either side


@pytest.mark.slow
def test_the_error_and_its_slope_are_those_of_the_series(twin: TwinParameters) -> None:
    vector, series = pack(twin, 1.0), twin.gear.kinematic_error
    for theta in np.linspace(-700.0, 700.0, 997):
        value, slope, _ = kernel.kinematic_error(theta, 0.0, vector)
        assert value == pytest.approx(float(series.value(theta)), abs=1e-16)
        assert slope == pytest.approx(float(series.slope(theta)), abs=1e-15)


def trace(parameters: TwinParameters, seed: int) -> list[tuple[float, ...]]:
    world, rows = World(parameters, seed), []
    for k in range(1, 500):
        world.command(0.8 * math.sin(k / 50))
        world.wait_until(k * 1e-3)
        rows.append(tuple(world.truth()))
    return rows


def test_the_same_seed_gives_the_same_run_to_the_last_bit(twin: TwinParameters) -> None:
    assert trace(twin, 3) == trace(twin, 3)


def test_another_seed_gives_another_run(twin: TwinParameters) -> None:
    assert trace(twin, 3)[0][:4] != trace(twin, 4)[0][:4]


@pytest.mark.parametrize("tau", [math.nan, math.inf, -math.inf, 1e300, 1e9])
def test_a_state_that_cannot_be_followed_fails_loudly_and_leaves_the_last_good_one(
    calm: TwinParameters, tau: float
) -> None:
    plant = Plant(calm, theta_m=1.0)
    plant.place(1.0, 5.0)
    before = plant.truth()
    with pytest.raises(PlantFailure, match="the twin's plant has failed"):
        plant.advance(1e-3, tau)
    assert plant.truth() == before
    assert np.all(np.isfinite(before))


@pytest.mark.parametrize("tau_ext", [math.nan, math.inf, 1e9, 1e12])
def test_a_load_no_rig_could_bear_fails_loudly_too(calm: TwinParameters, tau_ext: float) -> None:
    plant = Plant(calm)
    plant.tau_ext = tau_ext
    with pytest.raises(PlantFailure):
        plant.advance(1e-3, 0.0)


def test_a_runaway_is_followed_truly_or_refused(calm: TwinParameters) -> None:
    # a hundred times the drive's limit, no drag: RK4 at 1 ms would be wrong here long before it is infinite
    none = dict.fromkeys(("B_m", "B_l", "B_ml", "B_sp", "tau_c", "tau_s", "F_cl"), 0.0)
    plant = Plant(with_gear(calm, **none))
    for _ in range(50):
        plant.advance(1e-3, 500.0)
        assert abs(plant.ledger().residual) <= 1e-4 * plant.ledger().throughput
    assert plant.truth().omega_m > 1e4  # 100 000 rpm
    with pytest.raises(PlantFailure, match="too fast"):
        plant.advance(10.0, 5e5)


@pytest.mark.parametrize("sliver", [1e-18, 1e-15, 1e-12])
def test_a_sliver_of_time_changes_nothing(calm: TwinParameters, sliver: float) -> None:
    plant = Plant(calm)
    plant.place(300.0, 20.0)
    plant.advance(1e-3, 0.5)
    before = plant.truth(), plant.shaft
    plant.advance(sliver, 0.5)
    assert plant.truth() == pytest.approx(before[0], rel=1e-9)
    assert abs(before[1][2]) > 1.0
    assert plant.shaft == pytest.approx(before[1], rel=1e-6)  # its slope among them


@pytest.mark.slow
@pytest.mark.parametrize("changes", [{"B_sp": 3000.0}, {"B_m": 10.0}, {"B_l": 1e5}, {"K": 1e8}, {"omega_s": 0.001}])
def test_stiff_parameters_shorten_the_substeps_and_stay_true(calm: TwinParameters, changes: dict[str, float]) -> None:
    plant = Plant(with_gear(calm, **changes))
    plant.place(0.3, 2.0)
    for k in range(300):
        plant.advance(1e-3, 0.9 * math.sin(k / 30))
    ledger = plant.ledger()
    assert abs(ledger.residual) < 1e-5 * ledger.throughput


@pytest.mark.parametrize("field", ["tau_drive", "torque_noise", "watchdog", "sensor_range", "latch_l"])
def test_parameters_that_cannot_be_are_refused_by_name(twin: TwinParameters, field: str) -> None:
    with pytest.raises(UsageError, match=f"the twin's {field} is"):
        dataclasses.replace(twin, **{field: -1.0})


def test_a_gear_that_cannot_be_is_refused_by_name(twin: TwinParameters) -> None:
    with pytest.raises(UsageError, match=r"the twin's J_l is 0\.0, expected a finite number, more than 0"):
        with_gear(twin, J_l=0.0)
    with pytest.raises(UsageError, match=r"breakaway torque tau_s is 0\.1 N·m"):
        with_gear(twin, tau_s=0.1)


@pytest.mark.parametrize("number", [{"K": 1e300}, {"K": 1e16}, {"J_m": 1e-300}, {"J_l": 1e-300}, {"B_sp": 1e300}])
def test_a_gear_too_stiff_to_be_followed_is_refused_by_its_numbers(
    calm: TwinParameters, number: dict[str, float]
) -> None:
    with pytest.raises(UsageError, match=r"cannot follow a gear of K = .* N·m/rad.*expected at most .* 1/s"):
        Plant(with_gear(calm, **number))
