"""Of candidates nearly alike in the bank the one is taken that fits best once its shape is refined."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit import search
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.search import Scored
from rig.model.effects.cogging_torque import CoggingTorque
from rig.model.effects.support_compliance import SupportCompliance
from rig.model.effects.torsional_mode import DRIVEN, LOAD, MOTOR, TorsionalMode

SUPPORT = Term(SupportCompliance(), (0.0, 69.0, 0.05))
MODE, SAME_MODE = (Term(TorsionalMode(), (LOAD, hz, 0.04, 0.0)) for hz in (50.0, 54.0))
DRIVEN_MODE = Term(TorsionalMode(), (DRIVEN, 68.5, 0.04, 0.0))
SAME_MODE_MOTOR = Term(TorsionalMode(), (MOTOR, 50.0, 0.04, 0.0))
FAR = Term(CoggingTorque(), (4.0,))
AS_REFINED = {SUPPORT: 5668.0, MODE: 4275.0, SAME_MODE: 9e9, DRIVEN_MODE: 5813.0, SAME_MODE_MOTOR: 9e9, FAR: 9e9}


@pytest.fixture
def tried(monkeypatch: pytest.MonkeyPatch) -> list[Term]:
    seen: list[Term] = []

    def refined(d: Any, term: Term, runs: Any, covered: Any) -> Any:
        seen.append(term)
        return d, SimpleNamespace(gain=AS_REFINED[term], x=np.zeros(70), design=SimpleNamespace(terms=(term,)))

    monkeypatch.setattr(search, "refine", refined)
    monkeypatch.setattr(search, "each", lambda of, items: [of(item) for item in items])
    for name in ("extended", "fit"):
        monkeypatch.setattr(search, name, lambda *given: None)
    return seen


def chosen(*worth: tuple[Term, float]) -> Term:
    nothing: Any = None
    return search._best_refined(nothing, [Scored(t, e, 2 * e, 1.0) for t, e in worth], (), nothing)[0].term


def test_one_law_of_each_that_is_nearly_as_good_is_refined(tried: list[Term]) -> None:
    ranked = ((SUPPORT, 2443.0), (MODE, 2310.0), (SAME_MODE, 2300.0), (DRIVEN_MODE, 2200.0), (FAR, 900.0))
    assert chosen(*ranked) == DRIVEN_MODE
    assert tried == [SUPPORT, MODE, DRIVEN_MODE]


def test_what_is_far_ahead_is_refined_alone(tried: list[Term]) -> None:
    assert chosen((SUPPORT, 2443.0), (DRIVEN_MODE, 1500.0)) == SUPPORT
    assert tried == [SUPPORT]


def test_an_effect_keeps_those_of_its_laws_that_explain_nearly_as_much() -> None:
    """A rival is asked in each of them: which is best shows once their shapes are refined."""
    ranked = [
        Scored(t, e, 2 * e, 1.0) for t, e in ((SUPPORT, 802.0), (MODE, 717.0), (SAME_MODE, 700.0), (DRIVEN_MODE, 663.0))
    ]
    support, mode = search._best_of_each(
        [*ranked, Scored(Term(TorsionalMode(), (MOTOR, 50.0, 0.04, 0.0)), 300.0, 1.0, 1.0)], 0.85
    )
    assert (support.term, support.laws) == (SUPPORT, ())
    assert (mode.term, mode.laws) == (MODE, (DRIVEN_MODE,))


def test_a_law_of_more_coefficients_has_to_pay_for_them() -> None:
    """Plays by the load have six more than plays: at 12 nats each they must explain 72 more."""

    def worth(gain: float, size: int) -> float:
        s: Any = SimpleNamespace(gain=gain, x=np.zeros(size), design=SimpleNamespace(terms=(MODE,)))
        return search._worth(s)

    assert worth(1070.0, 76) < worth(1000.0, 70) < worth(1074.0, 76)


def test_every_effect_that_is_nearly_as_good_is_refined_before_a_second_law_of_one(tried: list[Term]) -> None:
    """Three laws of a stiffness that changes with the angle stood before the one cubic spring (exam 102, case 14)."""
    ranked = ((MODE, 2443.0), (DRIVEN_MODE, 2440.0), (SAME_MODE_MOTOR, 2430.0), (SUPPORT, 2400.0))
    assert chosen(*ranked) == DRIVEN_MODE
    assert tried == [MODE, SUPPORT, DRIVEN_MODE]
