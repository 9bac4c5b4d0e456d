"""Whether what a fitted run has to itself may be told: where a repeat, and not a part of itself, has none of it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
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


@pytest.mark.parametrize(
    ("column", "zero", "told"),
    [
        (np.ones((9, 1)), np.inf, True),  # a step between runs, of zeros that are free
        (np.ones((9, 1)), 1e-6, False),  # zeros are alike but for it: it shows in the error
        (np.r_[np.zeros((4, 1)), np.ones((5, 1))], np.inf, False),  # within a run
    ],
)
def test_a_step_between_runs_is_known_from_free_zeros_alone(
    monkeypatch: pytest.MonkeyPatch, column: np.ndarray, zero: float, told: bool
) -> None:
    design = SimpleNamespace(eq=SimpleNamespace(noise=SimpleNamespace(local={"A": zero})), y={KEY: None})
    monkeypatch.setattr(own_scores, "unseen", lambda s, held_out: design)
    monkeypatch.setattr(own_scores, "_taken", lambda *of: (0.1, 2.0))
    p: Any = SimpleNamespace(
        own=SimpleNamespace(made={"missed_counts": {KEY: column}}), held_out=SimpleNamespace(floors={})
    )
    scores = own_scores.own_scores(p, SimpleNamespace(design=design))  # type: ignore[arg-type]
    assert scores == {"missed_counts": (1.0, 0.0) if told else (0.1, 2.0)}
