"""A side that nobody reads answers by its resonance what comes fast: each run keeps that, or the rows are left out."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.answered import KEPT, NEAR, lowest_answered, slow_enough, told, too_fast
from rig.analysis.tracing.runs.recording import Recording
from rig.core.units import TURN

K, J_L, J_M, N = 7200.0, 0.8, 1.5e-3, 50.0
LOAD, MOTOR = NEAR * np.sqrt(K / J_L), NEAR * np.sqrt(K / J_M) / N  # rad/s
T = np.arange(0.0, 20.0, 0.004)


class Run(SimpleNamespace):
    keeps_speed = Recording.keeps_speed


def run(omega_m: Any, *lacks: str, locked: bool = False) -> Any:
    omega = np.broadcast_to(np.asarray(omega_m, float), T.shape)
    piece = SimpleNamespace(t=T, omega_m=omega, theta_m=np.cumsum(omega) * 0.004)
    return Run(
        pieces=(piece,), locked=locked, ratio=N, turning=float(np.mean(np.abs(omega))),
        has=frozenset({"theta_m", "theta_l", "tau_m", "tau_l", "t"}) - set(lacks),
        declared={"K": K, "J_l": J_L, "J_m": J_M},
    )  # fmt: skip


def swinging(most: float, each: float = 4.0) -> Any:
    """A joint's sine, `most` rad/s, `each` s a period."""
    return most * np.sin(TURN * T / each)


@pytest.mark.parametrize(
    ("lacks", "limit"),
    [
        ((), np.inf),
        (("theta_l",), np.inf),  # the torque sensor tells what the load takes
        (("tau_l",), np.inf),  # its encoder does
        (("theta_l", "tau_l"), LOAD),
        (("theta_m",), MOTOR),
        (("theta_l", "tau_l", "t"), np.inf),
        (("theta_l", "tau_l", "tau_m"), np.inf),
    ],
)
def test_the_side_that_was_not_read_sets_how_fast_is_too_fast(lacks: tuple[str, ...], limit: float) -> None:
    assert slow_enough(run(1.0, *lacks)) == pytest.approx(limit)
    assert slow_enough(run(1.0, *lacks, locked=True)) == np.inf


@pytest.mark.parametrize(("omega", "lowest"), [(1.0, np.inf), (6.3, 4), (42.0, 1)])
def test_orders_beyond_that_are_a_steady_runs_own(omega: float, lowest: float) -> None:
    assert lowest_answered(run(omega, "theta_l", "tau_l")) == lowest
    assert lowest_answered(run(omega)) == np.inf


def test_of_a_run_that_swings_slow_rows_alone_are_told() -> None:
    swings = run(swinging(1.2 * LOAD / KEPT, 20.0), "theta_l", "tau_l")
    rows = told(swings.pieces[0], swings)
    np.testing.assert_array_equal(rows > 0, np.abs(swings.pieces[0].omega_m) < LOAD / KEPT)
    assert not too_fast(swings)
    assert told(swings.pieces[0], run(swinging(5.0))).all()  # both sides were read


def test_a_swing_that_is_slow_at_few_angles_tells_nothing() -> None:
    swings = run(swinging(80.0), "theta_l", "tau_l")
    assert too_fast(swings)
    assert not told(swings.pieces[0], swings).any()
    assert not too_fast(run(80.0, "theta_l", "tau_l"))  # even: its waves are its own
