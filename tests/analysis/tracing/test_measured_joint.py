"""One measured run of a robot's joint, whose torque is a model of the arm: much is left, and no name is made up."""

from pathlib import Path

import pytest

from tests.studies.lara8 import imported, spiked, steps, traced

ARM = {"gravity_unbalance"}  # the arm's weight, which the baseline has no term for


@pytest.mark.slow
def test_what_is_left_goes_with_the_angle_of_the_joint_and_has_no_name(shared: Path, tmp_path: Path) -> None:
    verdict = traced(imported(tmp_path))["verdict"]
    assert (verdict["status"], verdict["coordinate"]) == ("unknown_effect", "load_angle")
    assert set(verdict["effects"]) <= ARM


@pytest.mark.slow
def test_no_effect_is_named_where_a_channel_it_acts_in_is_not_explained(shared: Path, tmp_path: Path) -> None:
    verdict = traced(spiked(imported(tmp_path), tmp_path / "spiked", steps, 5e-4))["verdict"]
    assert verdict["status"] == "unknown_effect"
    assert set(verdict["effects"]) <= ARM
