"""Whether what a fitted run has to itself may be told: where a repeat, and not a part of itself, has none of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.analysis.tracing.selection import own_scores

KEY = (0, "A")


@pytest.mark.parametrize(
    ("other", "alike", "has_some", "told"),
    [
        ("speed_2", True, False, True),
        ("speed_2", True, True, False),
        ("speed_2", False, False, False),
        (f"speed_1 ({HELD_PART})", True, False, False),
    ],
)
def test_only_a_repeat_that_has_none_speaks_for_it(
    monkeypatch: pytest.MonkeyPatch, other: str, alike: bool, has_some: bool, told: bool
) -> None:
    monkeypatch.setattr(own_scores, "alike", lambda a, b: alike)
    p: Any = SimpleNamespace(eq=SimpleNamespace(runs=[SimpleNamespace(name="speed_1"), SimpleNamespace(name=other)]))
    mine: Any = {KEY: None} | ({(1, "A"): None} if has_some else {})
    assert own_scores._has_repeat_without(p, KEY, mine) is told
