"""A counter made to run on again: any width, signed or not, exact."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rig.runfile.importing.unwrap import unwrap, wrapped_at


@st.composite
def journeys(draw: st.DrawFn) -> tuple[np.ndarray, int]:
    """(true counts, modulus): no step reaches half the modulus."""
    modulus = draw(st.integers(3, 2**40))
    most = (modulus - 1) // 2
    steps = draw(st.lists(st.integers(-most, most), min_size=1, max_size=60))
    start = draw(st.integers(-(2**45), 2**45))
    return np.cumsum([start, *steps], dtype=np.int64), modulus


@pytest.mark.slow
@given(journeys(), st.booleans())
def test_what_a_counter_lost_by_wrapping_comes_back_exactly(journey: tuple[np.ndarray, int], signed: bool) -> None:
    true, modulus = journey
    raw = true % modulus
    if signed:
        raw = np.where(raw >= (modulus + 1) // 2, raw - modulus, raw)
    back = unwrap(raw, float(modulus))
    assert back.dtype == np.int64
    assert np.array_equal(back - back[0], true - true[0])
    assert back[0] == raw[0]


@given(journeys())
def test_a_column_that_never_wraps_is_left_as_it_is(journey: tuple[np.ndarray, int]) -> None:
    true, modulus = journey
    assert np.array_equal(unwrap(true, float(modulus)), true)


@given(st.lists(st.floats(-179.0, 179.0), min_size=1, max_size=60), st.floats(-1e4, 1e4))
def test_degrees_unwrap_too(steps: list[float], start: float) -> None:
    true = np.cumsum([start, *steps])
    back = unwrap(true % 360.0, 360.0)
    assert np.allclose(back - back[0], true - true[0], rtol=0, atol=1e-8)


def test_a_jump_of_a_turn_is_seen_and_a_gap_in_time_excuses_it() -> None:
    raw = np.arange(0, 720, 3) % 360
    none = np.zeros(raw.size - 1, dtype=bool)
    assert wrapped_at(raw, (360.0, 65536.0), none) == (121, -357.0, 360.0)
    assert wrapped_at(raw, (360.0, 65536.0), ~none) is None
    assert wrapped_at(np.arange(0, 720, 3), (360.0,), none) is None
