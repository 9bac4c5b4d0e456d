"""Round numbers for an axis."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.live.view.ticks import rounded_out, step_for, ticks, written


def test_ticks_are_multiples_of_a_round_step_and_the_ends_belong_to_them() -> None:
    assert ticks(-60, 60) == [-60, -40, -20, 0, 20, 40, 60]
    assert ticks(0, 360, step=45) == [0, 45, 90, 135, 180, 225, 270, 315, 360]


def test_numbers_carry_the_decimals_of_their_step_and_a_true_minus() -> None:
    assert written(-0.25, 0.25) == "−0.25"
    assert written(20.0, 20.0) == "20"
    assert written(0.3, 0.1) == "0.3"
    assert written(0.0, 0.025) == "0.000"
    assert [written(tick, 2.5) for tick in ticks(-2.5, 7.5, most=4)] == ["−2.5", "0.0", "2.5", "5.0", "7.5"]
    assert written(25.0, 25.0) == "25"


@pytest.mark.parametrize("span", [0.0, -1.0, float("nan"), float("inf")])
def test_an_axis_over_nothing_is_refused(span: float) -> None:
    with pytest.raises(ValueError, match="above 0"):
        step_for(span, 6)


@given(st.floats(-1e6, 1e6), st.floats(1e-2, 1e6), st.integers(3, 9))
def test_a_widened_span_holds_what_it_was_widened_for_and_ends_at_ticks(low: float, span: float, most: int) -> None:
    start, end = rounded_out(low, low + span, most)
    slack = 1e-6 * max(abs(low), span)
    assert start <= low + slack
    assert end >= low + span - slack
    found = ticks(start, end, most)
    assert (found[0], found[-1]) == (pytest.approx(start, abs=slack), pytest.approx(end, abs=slack))
    assert 2 <= len(found) <= most + 1
