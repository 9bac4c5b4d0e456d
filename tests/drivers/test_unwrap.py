"""Counters that wrap."""

import pytest

from drivers.unwrap import Unwrapped


@pytest.mark.parametrize("modulus", [1 << 32, 1_296_000, 4096])
def test_counting_goes_on_over_the_wrap_both_ways(modulus: int):
    angle = Unwrapped(modulus, 100)
    angle.step(modulus - 10)
    assert angle.step(20) == 0
    assert angle.counts == modulus + 20
    assert angle.step(modulus - 10) == 0
    assert angle.counts == modulus - 10


def test_a_signed_counter_wraps_as_well():
    angle = Unwrapped(1 << 32, 100)
    angle.step(2**31 - 5)
    assert angle.step(-(2**31) + 5) == 0
    assert angle.counts == 2**31 + 5


def test_a_step_too_large_for_motion_is_told_and_counted_on():
    angle = Unwrapped(1 << 32, 100)
    angle.step(5_000)
    assert angle.step(0) == -5_000
    assert angle.step(3) == 0
    assert angle.counts == 3
