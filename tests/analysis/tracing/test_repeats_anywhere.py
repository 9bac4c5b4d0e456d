"""Two repeats are compared at equal motor angle, wherever in the triangle and at whichever angle they began."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor.repeats import compare, motor_turns, output_turns, scatter

NOISE, ROWS, SPAN, RATIO = 0.1, 6000, 8 * np.pi, 50.0


def triangle(phase: float, begins: float) -> np.ndarray:
    """Motor angle [rad] of two cycles that begin at `phase` of one, about the angle `begins`."""
    x = (phase + np.linspace(0.0, 2.0, ROWS)) % 1.0
    return begins + SPAN * np.where(x < 0.5, 2 * x, 2 - 2 * x)


def left(theta: np.ndarray, seed: int) -> np.ndarray:
    """What a run leaves: a wave of the motor's angle, which repeats share, and noise, which they do not."""
    return np.sin(7 * theta) + NOISE * np.random.default_rng(seed).standard_normal(theta.size)


@pytest.mark.parametrize("phase", [0.0, 0.1, 0.5, 0.7])
@pytest.mark.parametrize("begins", [0.0, 14 * np.pi, -6 * np.pi])
def test_what_differs_is_noise_alone_wherever_the_second_one_began(phase: float, begins: float) -> None:
    a, b = triangle(0.0, 1.0), triangle(phase, 1.0 + begins)
    d = compare(a, left(a, 1), b + motor_turns(a, b), left(b, 2))
    assert d.size > ROWS / 3
    assert float(np.std(d)) == pytest.approx(NOISE, rel=0.1)


def test_runs_that_share_no_angle_have_nothing_to_compare() -> None:
    a, b = triangle(0.0, 0.0), triangle(0.0, 100.0)
    assert compare(a, left(a, 1), b, left(b, 2)).size == 0


def test_only_the_motor_torque_is_compared_where_the_output_is_elsewhere() -> None:
    a, b = triangle(0.0, 0.0), triangle(0.3, 20 * np.pi)
    assert abs(output_turns(a, b, RATIO)) < 1e-9  # less than half a turn of the output apart
    rows = {(i, c): SimpleNamespace(theta_m=theta) for i, theta in enumerate((a, b)) for c in "AM"}
    eq: Any = SimpleNamespace(rows=rows, runs=[SimpleNamespace(ratio=RATIO)] * 2)
    e = {(i, c): left(theta, 2 * i + 5) for i, theta in enumerate((a, b)) for c in "AM"}
    assert scatter(eq, e, (0, 1), "A") is None
    found = scatter(eq, e, (0, 1), "M")
    assert found is not None
    assert found.rms == pytest.approx(NOISE, rel=0.1)
