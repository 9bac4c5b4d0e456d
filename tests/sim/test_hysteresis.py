"""Hysteresis of the spring: loops by their analytic area, closed minor loops, no dependence on rate."""

from __future__ import annotations

import dataclasses
import math
from types import ModuleType

import numpy as np
import pytest

from sim.effects import Effects, Hysteresis
from sim.parameters import TwinParameters
from sim.plant import Plant
from sim.vector import pack, slips
from tests.sim.conftest import FRICTIONLESS, with_gear

LAW = Hysteresis(torque=0.6, twist_deg=0.06, elements=4)
WIDEST = math.radians(LAW.twist_deg)  # rad
TICK = 1e-3  # s


def elements() -> tuple[np.ndarray, np.ndarray]:
    """k_i N·m/rad and s_i rad."""
    pairs = np.array(slips(LAW))
    return pairs[::2], pairs[1::2]


def loss_per_cycle(amplitude: float) -> float:
    """Area of the loop between ±`amplitude` rad: Σ 4·k_i·s_i·(X − s_i) of the elements that slip      [J]"""
    k, s = elements()
    return float(np.sum(4.0 * k * s * np.maximum(amplitude - s, 0.0)))


class Spring:
    """The plant's spring alone, its φ led by hand."""

    def __init__(self, plain: ModuleType, parameters: TwinParameters) -> None:
        self.parameters = parameters
        gear = dataclasses.replace(parameters.gear, K=1e-12)  # what is left is the hysteresis
        self.p = pack(dataclasses.replace(parameters, gear=gear, effects=Effects(hysteresis=LAW)), 1.0)
        self.kernel, self.module = plain, plain.entries.__globals__["substeps"].__globals__
        self.state, self.phi = np.zeros(plain.STATE_SIZE + LAW.elements), 0.0

    def go(self, target: float, longest: float = 1e-5) -> None:
        """Lead φ to `target` rad in steps of `longest` rad at most, each no further than its piece of the law goes."""
        slow = self.kernel.Slow(0.0, 0.0, 0.0)
        while self.phi != target:
            way = math.copysign(1.0, target - self.phi)
            spring = self.module["piece"]((0.0, 0.0, 0.0, 0.0), self.phi, way, slow, self.state, self.p)
            piece = spring.twist
            end = target if abs(target - self.phi) < longest else self.phi + way * longest
            limit = piece.high if way > 0.0 else piece.low
            if way * (end - limit) > 0.0:
                end = limit
            if end == self.phi:  # at the end of its piece: just behind it
                end = math.nextafter(self.phi, target)
            self.module["follow"](end - self.phi, 0.0, slow, spring, self.state, self.p)
            self.phi = end

    @property
    def torque(self) -> float:
        """N·m."""
        return float(elements()[0] @ self.state[self.kernel.STATE_SIZE :])

    @property
    def lost(self) -> float:
        """J."""
        return float(self.state[self.kernel.LOST_HYSTERESIS])


@pytest.fixture
def spring(plain: ModuleType, calm: TwinParameters) -> Spring:
    return Spring(plain, calm)


def test_the_elements_add_up_to_the_torque_and_slip_up_to_the_twist() -> None:
    k, s = elements()
    assert k @ s == pytest.approx(0.6)
    assert s.max() == pytest.approx(WIDEST)
    assert len(s) == 4


def test_the_first_winding_bends_from_the_stiffness_of_all_elements_to_the_full_torque(spring: Spring) -> None:
    k, s = elements()
    for phi in np.linspace(0.0, 1.5 * WIDEST, 40)[1:]:
        spring.go(float(phi))
        assert spring.torque == pytest.approx(float(np.sum(k * np.minimum(phi, s))), rel=1e-12)
    assert spring.torque == pytest.approx(0.6, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.2, 0.6, 1.0, 2.0])
@pytest.mark.parametrize("longest", [1e-6, 1e-3])
def test_a_closed_cycle_loses_the_area_of_its_loop_whatever_the_steps(
    spring: Spring, share: float, longest: float
) -> None:
    amplitude = share * WIDEST
    spring.go(amplitude, longest)
    before, torque = spring.lost, spring.torque
    spring.go(-amplitude, longest)
    assert spring.torque == pytest.approx(-torque, rel=1e-9)
    spring.go(amplitude, longest)
    assert spring.lost - before == pytest.approx(loss_per_cycle(amplitude), rel=1e-9, abs=1e-18)
    assert spring.torque == pytest.approx(torque, rel=1e-12)


def test_minor_loops_close_and_leave_no_trace(spring: Spring) -> None:
    spring.go(WIDEST)
    spring.go(-0.3 * WIDEST)
    held = spring.state.copy()
    for inner in (0.4, 0.15, 0.3):  # smaller turns inside of the large one
        spring.go(inner * WIDEST)
        spring.go(-0.3 * WIDEST)
        np.testing.assert_allclose(
            spring.state[spring.kernel.STATE_SIZE :], held[spring.kernel.STATE_SIZE :], atol=1e-15
        )
    undisturbed = Spring(spring.kernel, spring.parameters)
    undisturbed.go(WIDEST)
    for x in (spring, undisturbed):
        x.go(-WIDEST)
    assert spring.torque == pytest.approx(undisturbed.torque, rel=1e-12)


def lock_cycles(calm: TwinParameters, seconds: float, cycles: int = 2) -> tuple[float, float, float]:
    """Output locked, motor torque swung ±0.2 N·m; loss of the last cycle, that of its loop by formula, its amplitude.

    Without kinematic error and friction φ follows the torque, and its turning points are those of the torque.
    """
    none = dataclasses.replace(calm.gear.kinematic_error, a=(0.0,), b=(0.0,))
    gear = with_gear(calm, kinematic_error=none, B_m=0.05, **FRICTIONLESS)
    plant = Plant(dataclasses.replace(gear, effects=Effects(hysteresis=LAW)))
    plant.locked = True
    n, lost, phis = round(seconds / TICK), [], []
    for k in range(cycles * n + n // 4):
        plant.advance(TICK, 0.2 * math.sin(2 * math.pi * k / n))
        phis.append(plant.truth().phi)
        lost.append(plant.ledger().hysteresis)
    last = slice(-n - 1, None)
    high, low = max(phis[last]), min(phis[last])
    assert high == pytest.approx(-low, rel=1e-3)
    return lost[-1] - lost[-n - 1], loss_per_cycle((high - low) / 2), high


@pytest.mark.slow
def test_in_the_lock_test_the_loss_is_that_of_the_loop_at_any_rate(calm: TwinParameters) -> None:
    losses = []
    for seconds in (2.0, 6.0, 20.0):
        lost, by_formula, amplitude = lock_cycles(calm, seconds)
        assert amplitude > 0.8 * WIDEST
        assert lost == pytest.approx(by_formula, rel=2e-3)  # turning points are known to a tick
        losses.append(lost)
    assert max(losses) < 1.02 * min(losses)  # ten times slower: dampers would lose a tenth


def test_after_a_full_cycle_the_gear_rests_away_from_zero(calm: TwinParameters) -> None:
    plant = Plant(dataclasses.replace(with_gear(calm, **FRICTIONLESS), effects=Effects(hysteresis=LAW)))
    plant.locked = True
    for k in range(12000):
        plant.advance(TICK, 0.3 * math.sin(2 * math.pi * k / 4000) * (k < 6000))
    rest = abs(plant.truth().phi)
    assert 0.1 * LAW.torque / calm.gear.K < rest < LAW.torque / calm.gear.K
    assert abs(plant.truth().tau_l) < 2e-3
