"""What stays when every effect was eliminated: the gear as the baseline alone told it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.selection import selected


def solution(eq: str, *terms: Any) -> Any:
    return SimpleNamespace(design=SimpleNamespace(eq=eq, terms=terms))


@pytest.mark.parametrize("astray", [True, False])
def test_what_eliminated_effects_made_of_the_gear_goes_with_them(monkeypatch: pytest.MonkeyPatch, astray: bool) -> None:
    p: Any = SimpleNamespace(eq="as prepared", held_out=None)
    found: Any = SimpleNamespace(solution=solution("as searched", "an effect"), rough=False)
    none_left = solution("astray" if astray else p.eq)
    monkeypatch.setattr(selected, "backward_elimination", lambda s, at: (none_left, "held", []))
    monkeypatch.setattr(selected, "_floored", lambda p, s, runs: p)
    monkeypatch.setattr(selected, "_polished", lambda p, s, so_far, runs, covered: so_far)
    monkeypatch.setattr(selected, "_own_kept", lambda p, s: (p, s))
    monkeypatch.setattr(selected, "with_confounders", lambda s, runs, covered: s)
    monkeypatch.setattr(selected, "design", lambda eq, terms, runs: SimpleNamespace(eq=eq, terms=terms))
    monkeypatch.setattr(selected, "fit", lambda d: SimpleNamespace(design=d))
    monkeypatch.setattr(selected, "unseen", lambda s, at: f"held out {s.design.eq}")
    nothing: Any = None
    left = selected.select(p, found, (), nothing)
    assert left.solution.design.eq == "as prepared"
    assert left.held == ("held out as prepared" if astray else "held")
