"""A fit whose columns are made again with what it says: until they agree, and not where it runs away."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import search


@pytest.mark.parametrize(("left", "stays"), [
    ((100.0, 110.0, 112.0, 112.5), 112.5),  # columns that leaned on a little too much had explained a little more
    ((100.0, 140.0, 300.0, 900.0), 140.0),  # J_l of 1.1, 1.3, 2.0 and 6.2 kg·m², without a load angle
    ((100.0, 40.0, 39.0, 39.0), 39.0),
])  # fmt: skip
def test_a_fit_that_runs_away_stays_where_it_was(
    monkeypatch: pytest.MonkeyPatch, left: tuple[float, ...], stays: float
) -> None:
    class Design:
        """As much of it as is asked."""

        def __init__(self, turn: int) -> None:
            self.eq: Any = SimpleNamespace(turn=turn, rows="rows", noise=SimpleNamespace(weight=lambda channel: 1.0))
            self.terms = ("term",)

    def solution(turn: int) -> Any:
        e = np.array([np.sqrt(left[turn])])
        return SimpleNamespace(design=Design(turn), keys=[(0, "L")], residual=lambda key: e, left=left[turn])

    def leaning(eq: Any, s: Any, enough: float) -> Any:
        """Other equations each time, until there are no more."""
        after = Design(eq.turn + 1).eq
        return after if after.turn < len(left) else eq

    monkeypatch.setattr(search, "leaning", leaning)
    monkeypatch.setattr(search, "reduced", lambda d, gone: d)
    monkeypatch.setattr(search, "replace", lambda d, eq: SimpleNamespace(eq=eq, terms=d.terms))
    monkeypatch.setattr(search, "refine", lambda d, term, runs, covered: (None, solution(d.eq.turn)))
    nothing: Any = None
    found: Any = search.settled(solution(0), (), nothing)
    assert found.left == stays
