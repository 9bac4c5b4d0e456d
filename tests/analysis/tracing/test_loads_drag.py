"""A drag of the load that is more one way is what is left where the load's balance alone is above its floor."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual.uneven_drag import UnevenDrag
from rig.analysis.tracing.selection import verdict

DRAG = UnevenDrag(-0.6, 0.02, 42.0, 0.99, "L")


@pytest.mark.parametrize(
    ("over", "told"),
    [
        ({"A": 1.0, "M": 0.9, "L": 1.4, "R": 1.0}, True),
        ({"A": 1.0, "M": 1.3, "L": 1.4}, False),  # something else is left too
        ({"A": 1.0, "M": 0.9, "L": 1.0, "R": 2.0}, False),  # it is at reversals that something is left
        ({"A": 1.6}, False),  # no torque sensor
    ],
)
def test_it_is_told_where_nothing_else_is_left(
    over: dict[str, float], told: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(verdict, "uneven_drag", lambda s, fitted, unseen, floor, channel: DRAG)
    floors = {(0, channel): 0.05 for channel in over}
    p = SimpleNamespace(held_out=SimpleNamespace(floors=floors), split=SimpleNamespace(fitted=(0,), unseen=(1,)))
    after = {(0, channel): np.full(9, 0.05 * times) for channel, times in over.items()}
    asked: Any = SimpleNamespace(p=p, s=None, after=after, floors=floors, sized=("cogging_torque",))
    said = verdict._loads_drag(asked)
    assert (said is not None) is told
    if said:
        assert (said.verdict.coordinate, said.verdict.effects) == ("direction", ("cogging_torque",))
        assert said.verdict.sentence.startswith("The load is dragged by 0.6 ± 0.02 N·m more backward")
