"""What comes as often as the motor turns, where all runs turn alike, is a place on the motor and no clock."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.residual.lines import _as_the_motor_turns
from rig.core.units import RPM

APART = 0.01  # Hz, of runs of 100 s
SLOW = 9.6 * RPM  # 0.16 Hz


@pytest.mark.parametrize(("hz", "is_the_motor"), [(0.161, True), (0.32, True), (0.385, False), (0.24, False)])
def test_a_frequency_of_slow_runs_alone_is_the_motor_s_where_it_is_a_whole_number_of_its_turns(
    hz: float, is_the_motor: bool
) -> None:
    speeds, power = np.array([SLOW, SLOW, 20.0, 40.0]), np.array([5.0, 4.0, 0.1, 0.1])
    assert _as_the_motor_turns(hz, speeds, power, APART) is is_the_motor


def test_what_is_as_loud_at_another_speed_follows_the_clock() -> None:
    assert not _as_the_motor_turns(0.16, np.array([SLOW, SLOW, 20.0]), np.array([5.0, 4.0, 5.0]), APART)


def test_of_a_motor_so_slow_that_every_frequency_is_near_a_multiple_nothing_is_said() -> None:
    assert not _as_the_motor_turns(0.161, np.full(3, SLOW), np.ones(3), 0.05)


def test_runs_in_which_the_motor_rests_turn_no_more_often_than_never() -> None:
    assert not _as_the_motor_turns(0.16, np.zeros(3), np.ones(3), APART)
