"""Further selections: what is tried again, and what of it counts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from types import SimpleNamespace
from typing import Any, NamedTuple

import pytest

from rig.analysis.tracing.selection import further
from rig.analysis.tracing.selection.score import HeldOutScore


class Law(NamedTuple):
    """A term: an effect by name, in one of its laws."""

    name: str
    law: int


def selected(name: str, unsteady: float, left: float) -> Any:
    """One effect stands; `left` is what unseen runs have over their floor."""
    terms = (SimpleNamespace(name=name),)
    score = HeldOutScore(name, 0.9, 1.5, 1.0, 1.0, (), unsteady=unsteady, apart=unsteady)
    p = SimpleNamespace(baseline=SimpleNamespace(design=None))
    return SimpleNamespace(
        p=p, solution=SimpleNamespace(design=SimpleNamespace(terms=terms)), scores=[score], left=left, taken=frozenset()
    )


def instead(monkeypatch: pytest.MonkeyPatch, stands: Any, other: Any, evidence: float) -> tuple[str, int]:
    """What stands in the end where `stands` had evidence 100 and `other` the given one, and how many were tried."""
    tried: list[str] = []

    def selected_again(*_: object) -> Any:
        tried.append(other.scores[0].name)
        return other

    monkeypatch.setattr(further, "select", selected_again)
    monkeypatch.setattr(further, "refine", lambda *_: (None, None))
    monkeypatch.setattr(further, "settled", lambda *_: None)
    monkeypatch.setattr(further, "replace", lambda found, **_: found)
    monkeypatch.setattr(further, "_in_all", lambda one: one.left)
    ranking = tuple(
        SimpleNamespace(term=SimpleNamespace(name=one.scores[0].name), evidence=e)
        for one, e in ((stands, 100.0), (other, evidence))
    )
    found: Any = SimpleNamespace(ranking=ranking)
    return further.try_each_instead(stands, found, (), None).scores[0].name, len(tried)  # type: ignore[arg-type]


def test_a_steadier_look_alike_that_leaves_less_takes_the_place(monkeypatch: pytest.MonkeyPatch) -> None:
    support, mode = selected("support_compliance", 0.4, 0.95), selected("torsional_mode", 0.3, 0.9)
    assert instead(monkeypatch, support, mode, 90.0) == ("torsional_mode", 1)


@pytest.mark.parametrize(("unsteady", "left"), [(0.5, 0.9), (0.3, 1.0)])
def test_one_that_is_less_steady_or_leaves_more_does_not(
    monkeypatch: pytest.MonkeyPatch, unsteady: float, left: float
) -> None:
    support, mode = selected("support_compliance", 0.4, 0.95), selected("torsional_mode", unsteady, left)
    assert instead(monkeypatch, support, mode, 90.0) == ("support_compliance", 1)


def test_nothing_else_is_tried_where_one_size_suits_all_runs_or_nothing_else_explained_as_much(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    mode = selected("torsional_mode", 0.1, 0.5)
    assert instead(monkeypatch, selected("support_compliance", 0.1, 0.95), mode, 99.0) == ("support_compliance", 0)
    assert instead(monkeypatch, selected("support_compliance", 0.4, 0.95), mode, 70.0) == ("support_compliance", 0)


@pytest.mark.parametrize(
    ("stands", "left", "expected"),
    [
        ((), {1: 1.5, 2: 1.2, 3: 1.4}, {"a", "b"}),  # the least, though a third is kept as well
        (("c",), {1: 1.5, 2: 1.2, 3: 1.4}, {"a", "b", "c"}),  # no name is lost
        (("a",), {1: 9.0, 2: 9.0, 3: 9.0}, {"a"}),  # nothing better
    ],
)
def test_what_came_first_counts_where_it_leaves_less_and_loses_no_name(
    monkeypatch: pytest.MonkeyPatch, stands: tuple[str, ...], left: dict[int, float], expected: set[str]
) -> None:
    """The search found a (twice), b, c and d; in prefixes, of which nothing is eliminated."""

    def model(names: tuple[str, ...]) -> Any:
        terms = tuple(SimpleNamespace(name=name) for name in names)
        return SimpleNamespace(design=SimpleNamespace(terms=terms))

    def selected_again(p: Any, found: Any, *_: object) -> Any:
        names = {term.name for term in found.solution.design.terms}
        return SimpleNamespace(p=p, solution=found.solution, loud=True, left=left[len(names)])

    monkeypatch.setattr(further, "select", selected_again)
    monkeypatch.setattr(further, "fit", lambda design: SimpleNamespace(design=design))
    monkeypatch.setattr(further, "reduced", lambda d, gone: SimpleNamespace(terms=d.terms[: min(gone)]))
    monkeypatch.setattr(further, "replace", lambda found, solution: SimpleNamespace(solution=solution))
    p = SimpleNamespace(own=SimpleNamespace(line=None))
    selected: Any = SimpleNamespace(p=p, solution=model(stands), loud=True, left=2.0)
    found: Any = SimpleNamespace(solution=model(("a", "a", "b", "c", "d")), names=("a", "b", "c", "d"))
    kept = further.try_prefixes(selected, found, (), None)  # type: ignore[arg-type]
    assert {term.name for term in kept.solution.design.terms} == expected


def test_a_law_without_a_name_is_not_asked_where_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    def standing(names: tuple[str, ...], loud: bool, left: float) -> Any:
        terms = tuple(SimpleNamespace(name=name) for name in names)
        solution = SimpleNamespace(design=SimpleNamespace(terms=terms))
        p = SimpleNamespace(own=SimpleNamespace(line=None))
        return SimpleNamespace(p=p, solution=solution, loud=loud, left=left)

    monkeypatch.setattr(further, "fit", lambda design: SimpleNamespace(design=design))
    monkeypatch.setattr(further, "reduced", lambda d, gone: SimpleNamespace(terms=d.terms[: min(gone)]))
    monkeypatch.setattr(further, "replace", lambda found, solution: SimpleNamespace(solution=solution))
    terms = ("missed_counts", "sensor_scale", "lost_motion", "torsional_mode")
    found: Any = SimpleNamespace(solution=standing(terms, True, 2.0).solution, names=terms)
    for loud, expected in ((False, 1), (True, 2)):

        def selected_again(p: Any, found: Any, *_: object, loud: bool = loud) -> Any:
            names = tuple(term.name for term in found.solution.design.terms)[:2]
            return standing(names, loud, 1.0 / len(names))

        monkeypatch.setattr(further, "select", selected_again)
        kept = further.try_prefixes(standing((), True, 2.0), found, (), None)  # type: ignore[arg-type]
        assert len(kept.solution.design.terms) == expected


@pytest.mark.parametrize(("loud", "expected"), [(False, 3), (True, 2)])
def test_one_more_term_of_an_effect_that_stands_counts_where_it_explains_everything(
    monkeypatch: pytest.MonkeyPatch, loud: bool, expected: int
) -> None:
    """The search found a, b, a once more, and what chases b's first law."""

    def standing(names: tuple[str, ...]) -> Any:
        terms = tuple(SimpleNamespace(name=name) for name in names)
        solution, p = (
            SimpleNamespace(design=SimpleNamespace(terms=terms)),
            SimpleNamespace(own=SimpleNamespace(line=None)),
        )
        return SimpleNamespace(p=p, solution=solution, loud=len(names) < 3 or loud, left=3.0 - len(names) / 2)

    def selected_again(p: Any, found: Any, *_: object) -> Any:
        return standing(tuple(term.name for term in found.solution.design.terms))

    monkeypatch.setattr(further, "select", selected_again)
    monkeypatch.setattr(further, "fit", lambda design: SimpleNamespace(design=design))
    monkeypatch.setattr(further, "reduced", lambda d, gone: SimpleNamespace(terms=d.terms[: min(gone)]))
    monkeypatch.setattr(further, "replace", lambda found, solution: SimpleNamespace(solution=solution))
    found: Any = SimpleNamespace(solution=standing(("a", "b", "a", "c")).solution, names=("a", "b", "c"))
    kept = further.try_prefixes(standing(("a",)), found, (), None)  # type: ignore[arg-type]
    assert len(kept.solution.design.terms) == expected


def test_what_is_all_there_is_in_a_channel_of_its_own_is_named_beside_a_rest(monkeypatch: pytest.MonkeyPatch) -> None:
    """A weight stands in L, something loud is left in M: a runout in A is neither's."""
    monkeypatch.setattr(further, "confounders_in", lambda solution: [])
    monkeypatch.setattr(further, "_known", lambda other, stay: True)
    weight = HeldOutScore("gravity_unbalance", 0.997, 48.0, 2.8, 0.9, ((0, "L"),))
    runout = HeldOutScore("output_once_per_rev", 0.98, 5.6, 1.2, 0.93, ((0, "A"),))

    def stands(one: HeldOutScore, stay: set[str]) -> bool:
        other: Any = SimpleNamespace(scores=[weight, one], solution=None)
        return further._stands_alone(other, stay)

    assert stands(runout, {"gravity_unbalance"})
    assert not stands(replace(runout, ground=((0, "A"), (1, "L"))), {"gravity_unbalance"})  # what it acts in is shared
    assert not stands(replace(runout, share=0.85), {"gravity_unbalance"})
    assert not stands(replace(runout, left=1.5), {"gravity_unbalance"})
    assert not stands(runout, {"gravity_unbalance", "output_once_per_rev"})  # nothing is new


def test_an_effect_is_asked_in_all_its_laws_before_the_next_one_is() -> None:
    mode, driven, support = (Law(name, n) for name, n in (("mode", 0), ("mode", 6), ("support", 0)))
    terms: Any = [mode, support, mode]
    ranking: Any = [SimpleNamespace(term=mode, laws=(driven,)), SimpleNamespace(term=support, laws=())]
    assert further._in_all_laws(terms, ranking) == [mode, driven, support]


@pytest.mark.parametrize(("found_without", "left", "loud", "below", "expected"), [
    ({"lines"}, 1.0, True, "", {"lines"}),  # fewer names leave less
    ({"lines"}, 4.5, True, "", {"lines", "mode"}),  # fewer names leave more
    ({"lines", "play"}, 1.0, False, "", {"lines", "play"}),  # the others stand, and with a new one explain everything
    ({"lines", "play"}, 1.0, False, "tau_c", {"lines", "mode"}),  # of a motor that no gear has
    ({"lines", "play"}, 1.0, True, "", {"lines", "mode"}),
    ({"play"}, 1.0, False, "", {"lines", "mode"}),  # of the others one is lost
])  # fmt: skip
def test_what_is_found_without_one_of_several_names_counts_where_it_is_better(
    monkeypatch: pytest.MonkeyPatch, found_without: set[str], left: float, loud: bool, below: str, expected: set[str]
) -> None:
    """A mode in the place of an encoder's lines made another motor of this one. Without the lines nothing is found."""

    def standing(names: set[str], left: float, loud: bool) -> Any:
        terms = tuple(SimpleNamespace(name=name) for name in sorted(names))
        solution = SimpleNamespace(design=SimpleNamespace(terms=terms))
        scores = [SimpleNamespace(name=name) for name in sorted(names)]
        return SimpleNamespace(
            p=p, solution=solution, scores=scores, names=names, left=left, loud=loud, taken=frozenset()
        )

    def searched(design: Any, *_: object, excluded: frozenset[str], **__: object) -> Any:
        return found_without if excluded == {"mode"} else set()

    p = SimpleNamespace(own=SimpleNamespace(line=None), floors={})
    monkeypatch.setattr(further, "reduced", lambda d, gone: d)
    monkeypatch.setattr(further, "fit", lambda d: d)
    monkeypatch.setattr(further, "settled", lambda d, *_: SimpleNamespace(design=d))
    monkeypatch.setattr(further, "search_some", searched)
    monkeypatch.setattr(
        further, "select", lambda p, names, *_: standing(names, left, loud) if names else standing(set(), 9.0, True)
    )
    monkeypatch.setattr(further, "replace", lambda other, p: other)
    monkeypatch.setattr(further, "_known", lambda other, stay: True)

    def below_zero(s: Any, of: object) -> set[str]:
        return {below} if below and {term.name for term in s.design.terms} != {"lines", "mode"} else set()

    monkeypatch.setattr(further, "below_zero", below_zero)
    found: Any = SimpleNamespace(ranking=())
    nothing: Any = None
    kept = further.try_without_each(standing({"lines", "mode"}, 3.9, True), found, nothing, (), nothing)
    assert kept.names == expected


@pytest.mark.parametrize(
    ("then", "left", "plain", "known", "counts"),
    [
        (2.13, 0.98, True, True, True),
        (2.13, 1.35, True, True, False),  # a fifth of the excess is left
        (1.2, 0.98, True, True, False),  # there was little to take
        (2.13, 0.98, False, True, False),  # a size of its own in each run
        (2.13, 0.98, True, False, False),  # a scale that may be any
    ],
)
def test_a_second_choice_that_takes_most_plainly_counts_though_something_is_asked_for_it(
    monkeypatch: pytest.MonkeyPatch, then: float, left: float, plain: bool, known: bool, counts: bool
) -> None:
    """Cogging stands; a drag of exponent 1.7 beside it, fitted as of 2, leaves a mean at each speed."""
    monkeypatch.setattr(further, "confounders_in", lambda solution: ())
    monkeypatch.setattr(further, "_known", lambda other, stay: known)
    stands, drag = selected("cogging_torque", 0.1, then), selected("quadratic_drag", 0.1 if plain else 0.9, left)
    assert further._takes_most(drag, stands) is counts


@pytest.mark.parametrize(
    ("evidence", "explains", "loud", "expected"),
    [
        (99.0, True, True, {"eccentricity", "drag"}),
        (99.0, False, True, set()),
        (70.0, True, True, set()),  # no look-alike: it explained much less
        (99.0, True, False, set()),  # nothing is left to explain
    ],
)
def test_a_look_alike_in_an_eliminated_ones_place_keeps_what_stood_beside_that(
    monkeypatch: pytest.MonkeyPatch, evidence: float, explains: bool, loud: bool, expected: set[str]
) -> None:
    """Friction that falls up to the fastest run went, and the eccentricity beside it had no size of its own any more
    (exam 69, case 12)."""

    def standing(names: tuple[str, ...], loud: bool) -> Any:
        terms = tuple(SimpleNamespace(name=name) for name in names)
        solution = SimpleNamespace(design=SimpleNamespace(terms=terms))
        p = SimpleNamespace(own=SimpleNamespace(line=None))
        return SimpleNamespace(p=p, solution=solution, loud=loud, left=2.0, taken=frozenset())

    def reduced(d: Any, gone: list[int]) -> Any:
        return [term.name for i, term in enumerate(d.terms) if i not in gone]

    def selected_again(p: Any, found: Any, *_: object) -> Any:
        whole = {"eccentricity", "drag"} <= set(found.solution)
        return standing(tuple(found.solution) if whole else (), not (whole and explains))

    monkeypatch.setattr(further, "reduced", reduced)
    monkeypatch.setattr(further, "refine", lambda bare, term, *_: (None, [*bare, term.name]))
    monkeypatch.setattr(further, "settled", lambda names, *_: names)
    monkeypatch.setattr(further, "replace", lambda found, solution: SimpleNamespace(solution=solution))
    monkeypatch.setattr(further, "select", selected_again)
    monkeypatch.setattr(further, "_settles", lambda other, stay: not other.loud)
    monkeypatch.setattr(further, "_takes_most", lambda other, selected: False)
    names = ("eccentricity", "stribeck")
    ranking = [
        SimpleNamespace(term=SimpleNamespace(name=name), evidence=e)
        for name, e in (("eccentricity", 120.0), ("stribeck", 100.0), ("drag", evidence))
    ]
    found: Any = SimpleNamespace(solution=standing(names, True).solution, names=names, ranking=ranking)
    kept = further.try_instead_of_eliminated(standing((), loud), found, (), None)  # type: ignore[arg-type]
    assert {term.name for term in kept.solution.design.terms} == expected


@pytest.mark.parametrize(
    ("explains", "expected"),
    [
        ({"lines"}, {"lines"}),  # found again without the mode alone, which had spoilt its size (exam 97, case 08)
        ({"drag"}, {"drag"}),  # found for want of both
        (set(), set()),
    ],
)
def test_what_was_eliminated_is_found_again_without_what_came_first(
    monkeypatch: pytest.MonkeyPatch, explains: set[str], expected: set[str]
) -> None:
    """The search found a mode, then an encoder's lines; neither stands."""

    def model(names: Sequence[str]) -> Any:
        return SimpleNamespace(design=SimpleNamespace(terms=tuple(SimpleNamespace(name=name) for name in names)))

    def searched(*_: object, excluded: frozenset[str], **__: object) -> Any:
        found = next(name for name in ("mode", "lines", "drag") if name not in excluded)
        return SimpleNamespace(names=(found,), solution=model((found,)))

    def selected_again(p: Any, found: Any, *_: object) -> Any:
        stands = set(found.names) <= explains
        return SimpleNamespace(solution=found.solution if stands else model(()), loud=not stands)

    monkeypatch.setattr(further, "search_some", searched)
    monkeypatch.setattr(further, "select", selected_again)
    monkeypatch.setattr(further, "_settles", lambda other, stay: not other.loud)
    monkeypatch.setattr(further, "_stands_alone", lambda other, stay: False)
    monkeypatch.setattr(further, "_stands_in", lambda *_: False)
    p = SimpleNamespace(own=SimpleNamespace(line=None), floors={})
    first: Any = SimpleNamespace(p=p, solution=model(()), loud=True, taken=frozenset())
    found: Any = SimpleNamespace(ranking=(), names=("mode", "lines"))
    nothing: Any = None
    kept = further.try_without_eliminated(first, found, nothing, (), nothing)
    assert {term.name for term in kept.solution.design.terms} == expected
