"""The search for the slow speed: its speeds are read strictly, and the motor turns round between two of them."""

from __future__ import annotations

from itertools import pairwise

import pytest

from rig.core.errors import UsageError
from rig.procedures.full_turn import FullTurn
from rig.procedures.speed_convergence import SpeedConvergence


@pytest.mark.parametrize("speeds", ["60", "60,40", "40,60,80", "60,55,50", "60,forty,20", "60,0,-4", "60,,20", ""])
def test_speeds_that_make_no_search_are_refused(speeds: str) -> None:
    with pytest.raises(UsageError, match="speeds_rpm"):
        SpeedConvergence(speeds_rpm=speeds)


def test_between_two_speeds_the_motor_turns_round() -> None:
    waves = SpeedConvergence().waves
    for before, after in pairwise(waves):
        assert before.at(before.duration - 1e-6)[1] * after.at(1e-6)[1] < 0


def test_every_speed_is_the_slope_of_its_triangle_and_lasts_a_minute_at_least() -> None:
    procedure = SpeedConvergence()
    for speed, wave in zip(procedure.speeds, procedure.waves, strict=True):
        assert abs(wave.speed) * 30 / 3.141592653589793 == pytest.approx(0.993 * speed)
        assert wave.duration >= 60.0
        assert wave.cycles == int(wave.cycles)


def test_no_speed_keeps_step_with_rows_of_a_millisecond() -> None:
    for speed in SpeedConvergence().run_at:
        advance = speed / 60.0 * 10_000 * 1e-3  # counts of the motor encoder from row to row
        assert abs(advance - round(advance)) > 0.01


def test_a_full_turn_has_a_direction_of_two() -> None:
    with pytest.raises(UsageError, match="expected forward or reverse"):
        FullTurn(direction="left")
    assert FullTurn(direction="reverse").reference(50.0).distance == -FullTurn().reference(50.0).distance
