"""Where no share of the reference is the best one, it is taken for whole, and the analysis goes on."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from rig.analysis.stiffness import share
from rig.analysis.stiffness.share import UNDER_LOAD, Share, share_of


def bent(vertex: float, bend: float) -> Callable[[Any, Any, float], float]:
    """`_best` of a run whose scatter has its vertex there, or, without a bend, nowhere."""

    def best(points: Any, start: Any, near: float) -> float:
        assert near == near, "looked for beside a share that is not a number"
        return vertex if bend > 0 else float("nan")

    return best


@pytest.mark.parametrize(("vertex", "bend"), [(1.0, 0.0), (5.0, 1.0)])
def test_no_best_share_or_an_absurd_one_is_the_whole(
    monkeypatch: pytest.MonkeyPatch, vertex: float, bend: float
) -> None:
    nothing: Any = None
    monkeypatch.setattr(share, "fit", lambda *given: None)
    monkeypatch.setattr(share, "_best", bent(vertex, bend))
    assert share_of(nothing, nothing, nothing) == Share(1.0, UNDER_LOAD, False)
