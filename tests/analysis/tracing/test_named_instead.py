"""A name in the place of a law without one that it explains as much as."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.selection import named_instead as module
from rig.analysis.tracing.selection.named_instead import named_instead

LOOP, CREEP, SKEW, RIPPLE = "hysteretic_stiffness", "creep", "channel_time_skew", "torque_ripple"
BARE, WITH_CREEP = 1000.0, 9000.0


def solution(names: tuple[str, ...], gain: float, size: int) -> Any:
    y = {(0, "A"): np.zeros(60_000)}
    design = SimpleNamespace(
        terms=[SimpleNamespace(name=name) for name in names], size=size, y=y,
        eq=SimpleNamespace(noise=SimpleNamespace(kappa={"A": 3.0})),
    )  # fmt: skip
    return SimpleNamespace(gain=gain, design=design)


def selected(*names: str, gain: float, size: int = 60, left: float = 1.02, loud: bool = False) -> Any:
    p = SimpleNamespace(held_out=SimpleNamespace(residuals=lambda s, held: {0: s}, ratio=lambda e, keys: e[0].left))
    s = solution(names, gain, size)
    s.left = left
    return SimpleNamespace(p=p, solution=s, names=set(names), taken=frozenset(), loud=loud)


def stands(monkeypatch: pytest.MonkeyPatch, other: Any, brought: tuple[str, ...] = (RIPPLE, CREEP, SKEW)) -> set[str]:
    """What does in the end, where a creep and a channel that is late stood beside a ripple, and `other` is selected
    with a loop in their place."""
    before = selected(RIPPLE, CREEP, SKEW, gain=WITH_CREEP)
    removed: list[list[int]] = []

    def reduced(d: Any, gone: list[int]) -> Any:
        removed.append(gone)
        return d

    monkeypatch.setattr(module, "reduced", reduced)
    monkeypatch.setattr(module, "fit", lambda d: SimpleNamespace(design=d, gain=BARE))
    term = SimpleNamespace(name=LOOP)
    ranking = (SimpleNamespace(term=SimpleNamespace(name=CREEP)), SimpleNamespace(term=term))
    monkeypatch.setattr(module, "ranking_of_some", lambda *_: ranking)
    monkeypatch.setattr(module, "refine", lambda *_: (None, None))
    monkeypatch.setattr(module, "settled", lambda *_: None)
    monkeypatch.setattr(module, "replace", lambda found, **_: found)
    monkeypatch.setattr(module, "unseen", lambda s, at: None)
    monkeypatch.setattr(module, "select", lambda *_: other)
    found: Any = SimpleNamespace(names=brought)
    nothing: Any = None
    got = named_instead(before, found, nothing, (), nothing).names
    assert removed in ([[1, 2]], [])  # the law, and what came after it
    return set(got)


def test_a_loop_that_explains_all_but_a_fiftieth_takes_the_place_of_a_creep(monkeypatch: pytest.MonkeyPatch) -> None:
    """And of what came after it (exam 102, case 22)."""
    assert stands(monkeypatch, selected(RIPPLE, LOOP, gain=8840.0, size=52)) == {RIPPLE, LOOP}


@pytest.mark.parametrize(
    "other",
    [
        selected(RIPPLE, LOOP, gain=8000.0, size=52),  # falls short by an eighth
        selected(RIPPLE, LOOP, gain=8840.0, size=52, loud=True),
        selected(RIPPLE, LOOP, gain=8840.0, size=52, left=1.05),
        selected(RIPPLE, LOOP, gain=9500.0, size=61),  # more coefficients
        selected(RIPPLE, LOOP, "even_spring", gain=9500.0, size=52),  # another law without a name
        selected(RIPPLE, "angle_dependent_stiffness", gain=9500.0, size=52),  # it does not stand itself
    ],
)
def test_one_that_explains_less_or_needs_more_does_not(monkeypatch: pytest.MonkeyPatch, other: Any) -> None:
    assert stands(monkeypatch, other) == {RIPPLE, CREEP, SKEW}


def test_a_law_that_took_the_place_of_a_name_is_not_asked_again(monkeypatch: pytest.MonkeyPatch) -> None:
    other = selected(RIPPLE, LOOP, gain=9500.0, size=52)
    assert stands(monkeypatch, other, brought=(RIPPLE, LOOP, SKEW)) == {RIPPLE, CREEP, SKEW}
