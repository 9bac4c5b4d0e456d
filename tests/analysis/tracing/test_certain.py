"""What may be said where nothing is above the floor."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing.selection import certain as module
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.model.effect import Parameter


def alone(score: HeldOutScore, half: float = 0.1, law: float = 0.5) -> Any:
    """That effect as the only one that stands, its size known to `half` of itself and its frequency to `law` of it."""
    effect = SimpleNamespace(sizes=lambda words: words[:1], shape_names=("frequency",), loose=(True,))
    term = SimpleNamespace(name=score.name, effect=effect)
    size = Parameter("size", 1.0, (1.0 - half, 1.0 + half), "N·m")
    words = {score.name: (size, Parameter("frequency", 50.0, (50.0 - 50.0 * law, 50.0 + 50.0 * law), "Hz"))}
    solution = SimpleNamespace(design=SimpleNamespace(terms=[term]))
    return SimpleNamespace(
        p=SimpleNamespace(held_out="beside it"), scores=[score], solution=solution, words=words, held=()
    )


@pytest.fixture
def loud(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Floors above which something is left."""
    above = set[str]()
    monkeypatch.setattr(module, "confounders_in", lambda solution: [])
    monkeypatch.setattr(module, "is_loud", lambda at, solution, held: at in above)
    return above


def test_without_repeats_that_vouch_a_size_must_be_known_where_nothing_is_above_the_floor(
    loud: set[str],
) -> None:
    score = HeldOutScore("torsional_mode", 1.2, 0.8, 0.62, 1.0, ())
    assert module.is_certain(alone(score, 0.3), "as before")
    assert not module.is_certain(alone(score, 0.67), "as before")
    assert module.is_certain(alone(replace(score, as_repeats=True), 0.67), "as before")


def test_a_resonance_whose_size_unseen_runs_foretell_is_plain_though_few_runs_show_it(loud: set[str]) -> None:
    score = HeldOutScore("support_compliance", 0.99, 0.8, 0.62, 1.0, ())
    assert module.is_certain(alone(score, 2.0, 0.02), "as before")
    assert not module.is_certain(alone(score, 2.0, 0.5), "as before")
    assert not module.is_certain(alone(replace(score, share=0.9), 2.0, 0.02), "as before")
    assert not module.is_certain(alone(replace(score, size=0.6), 2.0, 0.02), "as before")


def test_what_a_fitted_run_shows_loudly_may_be_small_in_unseen_ones_where_repeats_vouch(
    loud: set[str],
) -> None:
    """A drive that warms has cooled down by the time of every run that is held out."""

    def certain(**said: Any) -> bool:
        score = HeldOutScore("thermal_friction_drift", 1.2, 0.35, 0.97, 0.9, (), **said)
        return module.is_certain(alone(score), "as before")

    assert certain(as_repeats=True, seen=3.9)
    assert not certain(as_repeats=True, seen=0.9)
    assert not certain(seen=3.9)


def test_what_repeats_vouch_for_may_be_smaller_where_nothing_is_above_the_floor(
    loud: set[str],
) -> None:

    def certain(**said: Any) -> bool:
        score = HeldOutScore("stribeck_friction", 1.2, 0.6, 0.8, 1.05, (), **said)
        return module.is_certain(alone(score), "as before")

    assert certain(as_repeats=True)
    assert certain(as_repeats=True, unsteady=0.65, apart=0.65)
    assert not certain()


def test_what_stands_out_of_the_floors_beside_it_alone_is_no_reason_against_it(loud: set[str]) -> None:
    score = HeldOutScore("tooth_mesh_error", 1.2, 0.8, 0.62, 1.0, ())
    loud.add("beside it")
    assert module.is_certain(alone(score), "as before")
    loud.add("as before")
    assert not module.is_certain(alone(score), "as before")


@pytest.mark.parametrize(
    ("names", "foretold", "left", "calm"),
    [
        ({"error_by_speed"}, False, {"A": 1.04, "M": 1.25}, True),
        ({"error_by_speed"}, False, {"A": 1.3, "M": 1.0}, False),
        ({"spring_drift"}, True, {"A": 1.04, "M": 1.0}, False),  # it stands in the means of unseen runs
        ({"error_by_speed", "stribeck_friction"}, False, {"A": 1.04, "M": 1.25}, False),  # asked as names are
        (set(), False, {"A": 1.04, "M": 1.25}, False),
    ],
)
def test_a_law_without_a_name_needs_a_reason_in_the_channel_it_acts_in(
    monkeypatch: pytest.MonkeyPatch, names: set[str], foretold: bool, left: dict[str, float], calm: bool
) -> None:
    monkeypatch.setattr(module, "unseen", lambda baseline, held_out: None)
    monkeypatch.setattr(module, "are_foretold", lambda p, selected: foretold)
    held_out = SimpleNamespace(
        residuals=lambda s, d: {(0, c): over for c, over in left.items()},
        beyond_chance=lambda e: (max(e.values()), max(e.values())),
    )
    p: Any = SimpleNamespace(baseline=None, held_out=held_out)
    scores = [HeldOutScore(name, 1.0, 0.5, 1.0, 1.0, ((0, "A"),)) for name in names]
    selected: Any = SimpleNamespace(names=names, scores=scores, p=p)
    assert module.is_calm_there(p, selected) is calm
