"""Ramps join without a step, and holding lasts whole turns."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.control.hold import hold
from rig.control.profile import Ramp
from rig.control.spin import hold_duration, hold_time, hold_travel, slow_down
from rig.control.winding import Winding
from rig.core.sample import Sample
from tests.fakes import SETTING

speeds = st.floats(-60.0, 60.0)


@given(start=speeds, end=speeds, t=st.floats(0.0, 20.0))
def test_the_speed_of_a_ramp_is_the_slope_of_its_offset(start: float, end: float, t: float) -> None:
    ramp, h = Ramp(start, end, 20.0), 1e-4
    slope = (ramp.at(t + 2 * h)[0] - ramp.at(t)[0]) / (2 * h)
    assert slope == pytest.approx(ramp.at(t + h)[1], abs=20.0 * h + 1e-6)


@given(start=speeds, end=speeds)
def test_a_ramp_ends_at_its_speed_after_its_travel_and_goes_on(start: float, end: float) -> None:
    ramp = Ramp(start, end, 20.0)
    offset, speed = ramp.at(ramp.duration + 1.0)
    assert speed == end
    assert offset == pytest.approx(ramp.travel + end, abs=1e-9)


@given(omega=st.floats(0.5, 60.0), seconds=st.floats(0.1, 10.0))
def test_holding_lasts_whole_turns_and_no_more_than_one_too_many(omega: float, seconds: float) -> None:
    turns = omega * hold_time(omega, seconds) / (2 * math.pi)
    assert turns == pytest.approx(round(turns), abs=1e-6)
    assert seconds - 1e-9 <= hold_time(omega, seconds) < seconds + 2 * math.pi / omega + 1e-9


@pytest.mark.parametrize("take", ["hold", "slow_down", "winding"])
def test_the_loop_takes_over_the_torque_there_is_without_a_jump(take: str) -> None:
    """At speed the hold gave the feed-forward on top of it."""
    setting = replace(SETTING, control=replace(SETTING.control, feedforward=0.01))
    sample = Sample(5.0, 1.0, 0.02, 30.0, 0.6, 10.0, 0.0, 0, 0, 0, "")
    match take:
        case "hold":
            steps = hold(setting)
            next(steps)
            asked = steps.send(sample)
        case "slow_down":
            asked = next(slow_down(setting, sample, sample.tau_m))
        case _:
            sample = sample._replace(omega_m=0.0)
            asked = Winding(setting, 4.0, sample).step(sample, 0.0)
    assert asked[0] == pytest.approx(sample.tau_m)


def test_travel_and_duration_of_a_hold_are_mirrored_with_its_speed() -> None:
    assert hold_travel(-30.0, 2.0) == -hold_travel(30.0, 2.0)
    assert hold_duration(-30.0, 2.0) == hold_duration(30.0, 2.0)
