"""Runs whose motor makes no whole turn: a jog is none for a trace, small sines are, beside runs that turn."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.runs.turned import swings_alone, too_short

T = np.arange(0.0, 8.0, 0.004)  # s
JOG = "its motor went 0.40 of a turn, a kinematic error needs a whole one"


def run(turns: np.ndarray, name: str = "run", procedure: str = "friction", locked: bool = False) -> Any:
    """Of a motor that goes so many `turns`."""
    pieces = (SimpleNamespace(theta_m=2 * np.pi * turns),)
    return SimpleNamespace(name=name, pieces=pieces, procedure=procedure, locked=locked)


def sine(turns: float, hz: float = 1.0) -> np.ndarray:
    """`turns` from one end to the other."""
    return np.asarray(turns / 2 * np.sin(2 * np.pi * hz * T))


@pytest.mark.parametrize(
    ("made", "why"),
    [
        (run(sine(0.4)), ""),
        (run(sine(0.4, hz=0.1)), JOG),  # less than two periods
        (run(np.linspace(0.0, 0.4, T.size)), JOG),
        (run(np.linspace(0.0, 1.2, T.size)), ""),
        (run(np.linspace(0.0, 0.4, T.size), locked=True), ""),
        (run(np.zeros(T.size), procedure="standstill"), ""),
        (run(sine(0.01)), JOG.replace("0.40", "0.01")),  # an encoder that hangs in its noise
    ],
)
def test_a_run_without_a_turn_counts_where_it_swings(made: Any, why: str) -> None:
    assert too_short(made) == why


def test_runs_that_swing_are_none_for_a_trace_by_themselves() -> None:
    swinging = [run(sine(0.4), "a"), run(sine(0.4), "b")]
    held = run(np.linspace(0.0, 3.0, T.size), "lock", locked=True)
    assert swings_alone([*swinging, held]) == {"a": JOG, "b": JOG}
    assert swings_alone([*swinging, run(np.linspace(0.0, 3.0, T.size), "turns")]) == {}
