"""Which effects may not stand, whatever they explain."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.selection import elimination
from rig.analysis.tracing.selection.elimination import _comes_round
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.core.units import TURN
from rig.model.effects import CATALOGUE


@pytest.mark.parametrize(("name", "order", "turns", "stands"), [
    ("torque_ripple", 3.0, 0.13, False), ("torque_ripple", 3.0, 0.4, True), ("torque_ripple", 24.0, 0.13, True),
    ("cogging_torque", 2.0, 0.1, False), ("gravity_unbalance", 1.0, 0.1, True),
])  # fmt: skip
def test_a_wave_of_the_motor_angle_goes_round_where_it_acts_most(
    name: str, order: float, turns: float, stands: bool
) -> None:
    """A locked output lets the motor turn a tenth: any curve over the torque is such a wave there. A weight is told by
    a part of the output's turn."""
    rows = {
        (0, "M"): SimpleNamespace(theta_m=TURN * np.linspace(0.0, turns, 100)),
        (1, "M"): SimpleNamespace(theta_m=TURN * np.linspace(0.0, 40.0, 100)),  # it hardly acts there
    }
    term = SimpleNamespace(name=name, effect=CATALOGUE[name], shape=(order,))
    d: Any = SimpleNamespace(terms=[term], eq=SimpleNamespace(rows=rows))
    assert _comes_round(d, HeldOutScore(name, 0.9, 4.0, 1.0, 1.0, ((0, "M"),))) is stands


@pytest.mark.parametrize(("sizes", "stay"), [
    ([-0.005, 0.05], [0.05]), ([0.05, 0.02], [0.05, 0.02]), ([-0.005, -0.05], []),
])  # fmt: skip
def test_of_two_terms_of_an_effect_the_one_that_cannot_be_goes_alone(
    sizes: list[float], stay: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A fall of friction over one speed is found first, and a better one beside it: what is left of the first is of
    the wrong sign, and no reason to let go of the second."""

    def solution(x: list[float]) -> Any:
        effect = SimpleNamespace(
            parameters=lambda one: (), adds=(), comes_round=False, plausible_together=lambda ones: True
        )
        terms = [SimpleNamespace(name="stribeck_friction", effect=effect, shape=(1.0,)) for _ in x]
        return SimpleNamespace(design=SimpleNamespace(terms=terms, place=lambda i: i, x=x), x=x)

    def reduced(d: Any, gone: list[int]) -> Any:
        return solution([size for i, size in enumerate(d.x) if i not in gone]).design

    def scores(s: Any, d: Any, at: Any) -> list[HeldOutScore]:
        return [HeldOutScore("stribeck_friction", 0.99, 4.0, 1.0, 1.0, ())] if d.terms else []

    for name, fake in {
        "unseen": lambda s, at: s.design,
        "scores": scores,
        "possible": lambda s, term, size: size > 0,
        "as_fit": lambda *a: None,
        "reduced": reduced,
        "fit": lambda d: solution(d.x),
        "_put_right": lambda s: s,
    }.items():
        monkeypatch.setattr(elimination, name, fake)
    nothing: Any = None
    left, _, _ = elimination.backward_elimination(solution(sizes), nothing)
    assert left.x == stay
