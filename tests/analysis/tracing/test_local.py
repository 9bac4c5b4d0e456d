"""Jumps are found where they are, and drift, waves and noise are no jumps."""

import numpy as np
import pytest

from rig.analysis.tracing.floor.local import _heights, _jumps

RNG = np.random.default_rng(8)
ANY = (0.0, np.inf)


def test_a_jump_is_found_at_its_row_with_its_size() -> None:
    e = 4e-6 * RNG.standard_normal(4000)
    e[2500:] += 3e-5
    (found,) = _jumps(e, np.ones(4000, bool), 7.0, ANY)
    assert abs(found[0] - 2500) <= 4
    assert found[1] == pytest.approx(3e-5, rel=0.2)


def test_a_jump_where_the_motor_turns_back_is_none() -> None:
    e = 4e-6 * RNG.standard_normal(4000)
    e[2500:] += 3e-5
    assert _jumps(e, np.abs(np.arange(4000) - 2500) > 43, 7.0, ANY) == []


def test_noise_drift_and_waves_have_no_jumps() -> None:
    n = np.arange(4000)
    for e in (0 * n, 1e-8 * n, 2e-5 * np.sin(n / 60)):
        assert _jumps(e + 4e-6 * RNG.standard_normal(n.size), n >= 0, 7.0, ANY) == []


def test_a_line_stands_out_of_its_surroundings_at_its_frequency() -> None:
    t = np.arange(5000) * 0.008
    grid = np.arange(1.0, 55.0, 0.02)
    heights = _heights(t, np.sin(2 * np.pi * 7.99 * t) + RNG.standard_normal(t.size), grid)
    assert grid[int(np.argmax(heights))] == pytest.approx(7.99, abs=0.05)
    assert np.mean(_heights(t, RNG.standard_normal(t.size), grid) > 15.0) < 1e-2
