"""Angles: unwrapping, the ratio two encoders agree on."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from rig.analysis.motion.angle import is_wrapped, measured_ratio, unwrap
from rig.core.units import TURN


@pytest.mark.slow
@given(
    hnp.arrays(np.int64, st.integers(2, 200), elements=st.integers(-8_388_000, 8_388_000)),
    st.integers(-(2**23), 2**23 - 1),
)
def test_a_signed_24_bit_counter_is_unwrapped_to_the_motion_that_made_it(steps: np.ndarray, start: int) -> None:
    true = start + np.cumsum(steps)
    wrapped = (true + 2**23) % 2**24 - 2**23
    assert np.array_equal(unwrap(wrapped.astype(float), 2.0**24) - wrapped[0], true - true[0])


def test_an_angle_that_jumps_by_whole_turns_is_seen_to_be_wrapped_and_a_fast_one_is_not() -> None:
    slow = np.linspace(0.0, 40.0, 5000)
    assert is_wrapped(np.mod(slow, TURN))
    assert not is_wrapped(slow)
    assert not is_wrapped(np.arange(1000) * 0.7 * TURN), "seven tenths of a turn every row is speed, not wrap"


def test_the_measured_ratio_is_negative_when_one_encoder_is_flipped() -> None:
    theta = np.linspace(0, 30, 1000)
    assert np.isclose(measured_ratio(theta, theta / 50), 50)
    assert np.isclose(measured_ratio(theta, -theta / 50), -50)
    assert np.isinf(measured_ratio(theta, np.zeros_like(theta)))
