"""Which effects may not stand, whatever they explain."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

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
