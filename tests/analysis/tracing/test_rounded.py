"""The floor that the rounding of encoders makes, beside rounded readings themselves."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.floor.rounded import rounded
from rig.analysis.tracing.runs.smoothing import Smoother

RATIO, DT, J_M, J_L = 50.0, 0.004, 1.4e-3, 0.8
COUNT_M, COUNT_L = 2 * np.pi / 8192, 2 * np.pi / 324_000
SMOOTHER = Smoother(36.0, DT, 1)


def equations(speed: float, locked: bool = False, thinned: int = 1) -> Any:
    """Of one run whose motor turns at that speed, rad/s."""
    piece = SimpleNamespace(dt=DT, thinned=thinned, gear=SimpleNamespace(J_m=J_M, J_l=J_L))
    run = SimpleNamespace(
        step_m=COUNT_M, step_l=COUNT_L, ratio=RATIO, turning=speed, locked=locked, has=frozenset({"t"}),
        pieces=[piece], smoother=SMOOTHER,
    )  # fmt: skip
    return SimpleNamespace(runs=[run], rows=dict.fromkeys([(0, c) for c in "AML"]))


def acceleration(speed: float, count: float) -> float:
    """RMS of what rounding to whole counts adds to it, rad/s²."""
    angle = speed * DT * np.arange(40_000) + 0.3 * np.sin(0.001 * np.arange(40_000))
    return float(np.std(SMOOTHER(np.round(angle / count) * count - angle, 2)))


@pytest.mark.parametrize("speed", [1.7, 6.3, 21.0])
def test_it_is_what_rounded_readings_leave_in_either_balance(speed: float) -> None:
    eq = equations(speed)
    assert rounded(eq, "L") == pytest.approx(J_L * acceleration(speed / RATIO, COUNT_L), rel=0.3)
    assert rounded(eq, "M") == pytest.approx(J_M * acceleration(speed, COUNT_M), rel=0.3)


def test_readings_that_several_made_are_as_much_finer() -> None:
    assert rounded(equations(20.0, thinned=4), "L") == pytest.approx(rounded(equations(20.0), "L") / 2)


def test_of_an_encoder_that_moves_by_less_than_a_count_a_row_nothing_is_known() -> None:
    assert rounded(equations(0.1), "L") == 0.0
    assert rounded(equations(20.0, locked=True), "L") == 0.0
    assert rounded(equations(20.0), "A") > 0.0


def test_the_least_of_all_runs_counts() -> None:
    coarse, fine = equations(20.0), equations(20.0)
    fine.runs[0].step_l /= 3
    both: Any = SimpleNamespace(runs=[*coarse.runs, *fine.runs], rows=dict.fromkeys([(0, "L"), (1, "L")]))
    assert rounded(both, "L") == pytest.approx(rounded(coarse, "L") / 3)
