"""What no gear has, and runs that do not belong together, are refused before a number is written down."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.identify.mode import add_mode
from rig.analysis.identify.possible import refuse_impossible, strange, taken_out
from rig.analysis.identify.recording import Recording, recording, refuse_another_ratio
from rig.analysis.identify.zeros import refuse_other_zeros
from rig.core.errors import DataError
from rig.model.gearfile import Parameter
from tests.analysis.synthetic import slow_run


def slow(seed: int, name: str) -> Recording:
    run = recording(slow_run(seed, manifest={"declared": {"K": 7160.0}}))
    assert run is not None
    return replace(run, name=name)


def further(run: Recording, shift: float) -> Recording:
    """The same motion, counted from a zero `shift` rad away."""
    return replace(run, motion=replace(run.motion, theta_m=run.motion.theta_m + shift))


def test_runs_of_two_zeros_of_the_motor_encoder_are_not_identified_together() -> None:
    one, other = slow(1, "one"), further(slow(2, "other"), np.deg2rad(30.0))
    further_on = r"other counts .* another zero than one: .* (29\.9|30\.0)\d+ ± 0\.\d+ degrees"
    with pytest.raises(DataError, match=further_on):
        refuse_other_zeros([one, other])


@pytest.mark.slow
def test_runs_of_one_zero_are() -> None:
    refuse_other_zeros([slow(1, "one"), slow(2, "other"), further(slow(3, "hardly moved"), np.deg2rad(0.2))])


def measured(value: float, half: float) -> Parameter:
    return Parameter(value, (value - half, value + half), "measured")


@pytest.mark.parametrize(("name", "sensor"), [("J_l", "tau_l"), ("tau_c", "tau_m"), ("F_cl", "tau_l")])
def test_a_negative_inertia_or_friction_says_which_sensor_is_the_wrong_way_round(name: str, sensor: str) -> None:
    with pytest.raises(DataError, match=f"^{name} comes out at -0.3 ± 0.01 .*above 0: {sensor} seems"):
        refuse_impossible({name: measured(-0.3, 0.01)})
    refuse_impossible({name: measured(-0.001, 0.01)})  # zero, as far as anybody can tell
    refuse_impossible({name: measured(-7.5e-5, 6.2e-5)})  # and a little below, as one time in forty


def test_a_number_far_from_what_is_declared_is_said_with_both() -> None:
    far = strange({"K": measured(7.16e6, 1e3), "B_sp": measured(-4.4, 1.0)}, {"K": {"value": 7160.0}})
    assert [sentence.split(" ")[0] for sentence in far] == ["B_sp", "K"]
    assert "declared 7160 N·m/rad" in far[1]
    assert strange({"K": measured(6000.0, 10.0), "B_sp": measured(-0.1, 1.0)}, {"K": 7160.0}) == []


def test_a_ratio_off_by_half_a_per_cent_is_refused_where_the_torque_says_it_is_no_wind_up() -> None:
    run = slow(1, "one")
    free = replace(run, tau_l=np.zeros(run.t.size))
    refuse_another_ratio([free])
    with pytest.raises(DataError, match=r"declared 50: θ̃ grows by"):
        refuse_another_ratio([replace(free, motion=replace(free.motion, theta_l=1.006 * free.theta_l))])


def test_an_inertia_that_may_as_well_be_negative_has_no_frequency() -> None:
    """−0.0007 ± 0.005 kg·m² at the motor, as of a torque in another unit: the square root of it ended in an error."""
    sizes = {"N": (50.0, 0.0), "J_m": (-0.0007, 0.005), "J_l": (0.4, 0.01), "K": (7160.0, 10.0), "B_sp": (4.0, 0.1)}
    found = {name: measured(value, half) for name, (value, half) in sizes.items()}
    add_mode(found, cast(Any, None))
    assert found.keys() == sizes.keys()


def test_a_number_no_gear_has_is_taken_out_however_uncertain_and_said_to_be() -> None:
    found = {
        "J_m": measured(-1e-4, 1e-3),
        "tau_c": measured(-0.001, 0.01),
        "B_sp": measured(-0.5, 3.0),
        "F_cl": measured(0.0, 0.1),
        "K": measured(7000.0, 10.0),
    }
    said = taken_out(found)
    assert sorted(found) == ["F_cl", "K"]
    assert said[0] == "J_m cannot be told: it comes out at -0.0001 ± 0.001 kg·m², expected above 0."
    assert [sentence.partition(" ")[0] for sentence in said] == ["J_m", "tau_c", "B_sp"]
    assert said[1].endswith("expected 0 or more.")
