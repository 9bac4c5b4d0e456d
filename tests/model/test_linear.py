"""The closed forms at their limits, and the numbers that physics gives for the bench's rig."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from rig.bench import read, twin_parameters
from rig.model.gear import Gear
from rig.model.linear import damping_ratio, effective_inertia, natural_frequency, transmissibility


@pytest.fixture(scope="module")
def gear() -> Gear:
    found: Gear = twin_parameters(read("twin").file).gear
    return found


def test_the_rig_swings_freely_at_25_hz_with_4_percent_of_critical_damping(gear: Gear) -> None:
    assert natural_frequency(gear) / (2 * math.pi) == pytest.approx(25.15, abs=0.02)
    assert damping_ratio(gear) == pytest.approx(0.04, abs=0.001)


def test_turning_slowly_the_kinematic_error_is_the_pure_one(gear: Gear) -> None:
    assert np.allclose(np.abs(transmissibility(gear, np.arange(1.0, 16.0), 1e-4)), 1.0, atol=1e-6)


def test_far_above_resonance_the_load_stops_following(gear: Gear) -> None:
    assert abs(transmissibility(gear, np.array(15.0), 1e4)) < 0.05


def test_at_resonance_only_damping_limits_it(gear: Gear) -> None:
    zeta, omega = damping_ratio(gear), natural_frequency(gear)
    peak = abs(transmissibility(gear, np.array(2.0), omega / 2))
    assert peak == pytest.approx(math.sqrt(1 + 1 / (4 * zeta**2)), rel=1e-9)


def test_a_clamped_motor_leaves_the_load_alone_on_the_spring(gear: Gear) -> None:
    heavy = replace(gear, J_m=1e9)
    assert effective_inertia(heavy) == pytest.approx(gear.J_l, rel=1e-6)
