"""What is read wrong is in the motor's balance by all that stands there with it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from rig.analysis.tracing.fit.footprint import footprint
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import MEASURED, Array, Port
from tests.contract.test_effects import DT, KNOWN, motion

SIZE = 2e-3  # rad, of an eccentric disc
GEAR = dataclasses.replace(KNOWN, B_m=4e-3)
SMOOTH = Smoother(20.0, DT, 4)


def balanced(theta: Array, torque: Array) -> Array:
    """J_m·ω̇_m + B_m·ω_m − T·θ̃_p′ of an angle [rad], through the low-pass."""
    drag = GEAR.J_m * SMOOTH(theta, 2) + GEAR.B_m * SMOOTH(theta, 1)
    return np.asarray(drag - SMOOTH(torque * GEAR.kinematic_error.slope(theta)))


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_all_of_an_eccentric_disc_is_in_its_column(way: float) -> None:
    true = dataclasses.replace(motion(way), gear=GEAR)
    error = SIZE * np.cos(true.theta_m + 0.7)
    seen = dataclasses.replace(true, theta_m=true.theta_m + error)
    missed = balanced(true.theta_m, true.torque) - balanced(seen.theta_m, true.torque)
    told = footprint({Port.READS_THETA_M: error[:, None]}, seen, SMOOTH, MEASURED)["M"][:, 0]
    assert np.abs(told - missed).max() < 0.02 * np.abs(missed).max()


def test_what_it_drags_and_where_the_lever_stands_is_no_little_of_it() -> None:
    """Without them a disc that is 12 mrad off left motor ripple and friction behind, both named."""
    s = dataclasses.replace(motion(), gear=GEAR)
    error = SIZE * np.cos(s.theta_m + 0.7)[:, None]
    whole = footprint({Port.READS_THETA_M: error}, s, SMOOTH, MEASURED)["M"]
    inertia = SMOOTH(-GEAR.J_m * error, 2)
    assert np.sqrt(np.mean((whole - inertia) ** 2)) > 0.2 * np.sqrt(np.mean(inertia**2))


def test_a_torque_that_is_read_wrong_is_in_the_lever_as_well() -> None:
    s = dataclasses.replace(motion(), gear=GEAR)
    error = 0.4 * np.cos(s.theta_l + 0.2)  # N·m
    wrong = -error / s.ratio + error * GEAR.kinematic_error.slope(s.theta_m)  # of τ_m − T/N + T·θ̃_p′
    told = footprint({Port.READS_TAU_L: error[:, None]}, s, SMOOTH, MEASURED)["M"][:, 0]
    np.testing.assert_allclose(told, SMOOTH(wrong), atol=1e-3 * np.abs(wrong).max())
