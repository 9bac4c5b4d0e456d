"""Noise of a run that was never compared is what goes with no angle."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.tracing.floor.stroke_by_stroke import beside_the_angle

THETA = np.concatenate([np.linspace(-1.0, 1.0, 2000), np.linspace(1.0, -1.0, 2000)])


def test_a_friction_that_grows_with_the_load_is_no_noise(rng: np.random.Generator) -> None:
    noise = 0.002 * rng.standard_normal(THETA.size)
    friction = 0.01 * np.abs(THETA) * np.repeat([1.0, -1.0], 2000)
    left = beside_the_angle(THETA, friction + noise)
    assert float(np.sqrt(np.mean(left**2))) == pytest.approx(0.002, rel=0.08)


def test_what_goes_with_no_angle_stays(rng: np.random.Generator) -> None:
    slips = np.repeat(0.01 * rng.standard_normal(200), 20)
    left = beside_the_angle(THETA, slips)
    assert float(np.std(left)) == pytest.approx(float(np.std(slips)), rel=0.15)


def test_few_rows_are_left_as_they_are() -> None:
    e = np.linspace(0.0, 1.0, 50)
    np.testing.assert_array_equal(beside_the_angle(THETA[:50], e), e)
