"""Friction from the means of plateaus: which plans tell its parts from each other."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.identify.friction import motor_friction
from rig.analysis.identify.means import Mean, Torque

B, TAU_C, OFFSET = 3e-3, 0.3, 0.01


def plateau(run: str, rpm: float, noise: np.random.Generator, square: float = 0.0) -> Mean:
    """One stretch of 10 s under B·ω + τ_c·sgn ω + offset, and `square`·ω·|ω|."""
    omega = rpm * np.pi / 30
    drag = B * omega + square * omega * abs(omega)
    pieces = drag + TAU_C * np.sign(omega) + OFFSET + 1e-3 * noise.standard_normal(30)
    side = Torque(float(np.mean(pieces)), pieces)
    return Mean(run, omega, 10.0, side, side, side, 0.0, 0.0)


@pytest.mark.parametrize("fast", [(120.0, 300.0), (120.0, 300.0, -120.0, -300.0)])
def test_slow_strokes_both_ways_and_fast_runs_of_one_or_both_give_the_whole_coulomb_friction(
    fast: tuple[float, ...],
) -> None:
    noise = np.random.default_rng(1)
    speeds = (9.6, -9.6, 9.6, -9.6, *fast, *fast)
    found = motor_friction([plateau(f"run-{i}", rpm, noise) for i, rpm in enumerate(speeds)])
    assert found is not None
    assert found.doubt == ""
    for i, true in ((found.B, B), (found.tau_c, TAU_C), (found.offset or 2, OFFSET)):
        assert found.solved.coefficients[i] == pytest.approx(true, abs=4 * found.solved.u(i) + 1e-6)
    assert found.solved.u(found.tau_c) < 0.02 * TAU_C


SPEEDS = tuple(sign * rpm for rpm in (60.0, 120.0, 200.0, 300.0, 400.0) for sign in (1.0, -1.0, 1.0, -1.0))


def bend(square: float, speeds: tuple[float, ...] = SPEEDS) -> str:
    noise = np.random.default_rng(2)
    found = motor_friction([plateau(f"run-{i}", rpm, noise, square) for i, rpm in enumerate(speeds)])
    assert found is not None
    return found.bend


def test_a_line_that_is_straight_is_not_said_to_bend() -> None:
    assert bend(0.0) == ""


def test_a_drag_with_the_square_of_the_speed_is_told_with_what_it_makes_of_the_line() -> None:
    said = bend(1e-5)
    top = 1e-5 * (400 * np.pi / 30) ** 2
    assert f"{top:.4f}"[:5] in said, said
    assert "at 400 rpm" in said


def test_three_speeds_do_not_tell_a_bend() -> None:
    assert bend(1e-5, tuple(s for s in SPEEDS if abs(s) in (60.0, 200.0, 400.0))) == ""
