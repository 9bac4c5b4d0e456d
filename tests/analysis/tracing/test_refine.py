"""An exponent is that of the textbook's law that fits best, until the runs tell another one plainly."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import refine
from rig.analysis.tracing.fit.equations import Term
from rig.model.effects.presliding_friction import BRISTLE, ELEMENTS, MOTOR, PreslidingFriction
from rig.model.effects.stribeck_friction import StribeckFriction

WITHOUT, EFFECT = 1e6, 2e4  # gain of the model without it, and what the effect adds to that
STRIBECK = Term(StribeckFriction(), (1.0, 1.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("more", "rows", "better", "exponent"),
    [
        (20.0, 0, 2.0, 2.0),
        (20.0, 0, 1.0, 1.0),
        (150.0, 30_000, 2.0, 2.0),
        (150.0, 30_000, 1.0, 1.0),
        (250.0, 30_000, 2.0, 2.7),
        (250.0, 30_000, 1.0, 2.7),
        (150.0, 6_000, 2.0, 2.7),
    ],
)
def test_another_exponent_takes_a_hundredth_of_what_the_effect_explains_or_of_the_noise(
    monkeypatch: pytest.MonkeyPatch, more: float, rows: int, better: float, exponent: float
) -> None:
    tried = []

    def refined(d: Any, term: Term, runs: Any, covered: Any, free: list[int]) -> Any:
        tried.append((term.shape, free))
        shape = (1.2, 2.7, 0.0, 0.0) if 1 in free else (1.3, *term.shape[1:])
        other = 0.0 if shape[1] in (better, 2.7) else -300.0
        found = SimpleNamespace(gain=WITHOUT + EFFECT + other + (more if 1 in free else 0.0))
        return SimpleNamespace(terms=(Term(term.effect, shape),)), found

    monkeypatch.setattr(refine, "_refined", refined)
    monkeypatch.setattr(refine, "fit", lambda d: SimpleNamespace(gain=WITHOUT))
    nothing: Any = None
    noise = SimpleNamespace(kappa={"M": 2.0})
    d: Any = SimpleNamespace(y={(0, "M"): np.zeros(2 * rows)}, eq=SimpleNamespace(noise=noise), terms=())
    best, _ = refine.refine(d, STRIBECK, (), nothing)
    assert best.terms[-1].shape[1] == exponent
    textbook = [((1.2, exponent, 0.0, law), [0]) for exponent in (1.0, 2.0) for law in (0.0, 1.0)]
    assert tried == [((1.0, 1.0, 0.0, 0.0), [0, 1]), *textbook]


def test_beside_another_term_of_the_effect_an_exponent_stays_as_it_is(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two of them run away from each other: a difference of two powers is a third one."""
    tried = []

    def refined(d: Any, term: Term, runs: Any, covered: Any, free: list[int]) -> Any:
        tried.append(free)
        return d, None

    monkeypatch.setattr(refine, "_refined", refined)
    nothing: Any = None
    d: Any = SimpleNamespace(terms=(Term(StribeckFriction(), (3.0, 1.0, 0.0, 0.0)),))
    refine.refine(d, STRIBECK, (), nothing)
    assert tried == [[0]]


@pytest.mark.parametrize("law", [BRISTLE, ELEMENTS])
def test_in_its_law_only_the_way_is_found(monkeypatch: pytest.MonkeyPatch, law: float) -> None:
    tried = []

    def refined(d: Any, term: Term, runs: Any, covered: Any, free: list[int]) -> Any:
        tried.append((term.shape[2], [term.effect.shape_names[i] for i in free]))
        return d, None

    monkeypatch.setattr(refine, "_refined", refined)
    nothing: Any = None
    refine.in_its_law(nothing, Term(PreslidingFriction(), (MOTOR, 0.01, law)), (), nothing)
    assert tried == [(law, ["x_0"])]
