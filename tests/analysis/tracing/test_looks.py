"""What a second look may take away of what the first has named."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing import looks
from rig.analysis.tracing.looks import reversals
from rig.analysis.tracing.looks.reversals import _adds
from rig.analysis.tracing.selection.score import HeldOutScore
from rig.model.effects.presliding_friction import BRISTLE, ELEMENTS, MOTOR

BUILT = HeldOutScore("presliding_friction", 1.0, 14.4, 0.8, 1.0, ((0, "R"),))
SMALL = HeldOutScore("stribeck_friction", 0.9, 1.0, 1.05, 1.0, ((0, "M"),))


def selected(*scores: HeldOutScore, loud: bool = False) -> Any:
    return SimpleNamespace(scores=scores, names={score.name for score in scores}, loud=loud)


@pytest.mark.parametrize(
    ("lost", "counts"),
    [
        (SMALL, True),
        (replace(SMALL, size=2.0), False),  # no tenth of it
        (replace(SMALL, ground=((0, "A"),)), False),  # in a channel that the motor's friction does not act in
    ],
)
def test_a_name_may_be_lost_in_the_motors_torque_alone_and_where_it_is_a_tenth(
    lost: HeldOutScore, counts: bool
) -> None:
    assert _adds(selected(BUILT), selected(lost)) is counts


def test_it_counts_where_it_is_named_and_leaves_no_more() -> None:
    assert not _adds(selected(SMALL), selected(SMALL))
    assert not _adds(selected(BUILT, loud=True), selected())
    assert _adds(selected(BUILT, loud=True), selected(loud=True))


@pytest.mark.parametrize(("first", "tried"), [(BRISTLE, [BRISTLE]), (ELEMENTS, [ELEMENTS, BRISTLE])])
def test_where_several_elements_cannot_be_told_one_bristle_is_tried(
    first: float, tried: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Elements that slip over less than the motor goes between two samples fit a little better, and have no name."""

    def solved(law: float) -> Any:
        terms = (SimpleNamespace(shape=(MOTOR, 0.004, law)),)
        return SimpleNamespace(design=SimpleNamespace(terms=terms), gain=0.0)

    asked: list[float] = []

    def select(p: Any, found: Any, runs: Any, covered: Any) -> Any:
        asked.append(found.solution.design.terms[-1].shape[2])
        return selected(BUILT) if asked[-1] == BRISTLE else selected()

    nothing: Any = None
    p = SimpleNamespace(split=SimpleNamespace(fitted=()), eq=SimpleNamespace(runs=()))
    for name, fake in {
        "builds_up": lambda runs: (False,),
        "prepare": lambda *a: p,
        "looking": lambda *a: nothing,
        "reach": lambda *a: SimpleNamespace(slowest=1.0, rate=250.0, ratio=50.0),
        "design": lambda *a: nothing,
        "extended": lambda *a: nothing,
        "fit": lambda d: SimpleNamespace(gain=0.0),
        "refine": lambda *a: (nothing, nothing),
        "settled": lambda *a: solved(first),
        "in_its_law": lambda d, term, runs, covered: (nothing, solved(term.shape[2])),
        "replace": lambda term, shape: SimpleNamespace(shape=shape),
        "beside": lambda p, s, covered: (p, s),
        "select": select,
        "_out_of_its_shadow": lambda other, *a: other,
    }.items():
        monkeypatch.setattr(reversals, name, fake)
    so_far = selected()
    so_far.solution, so_far.fitted_runs = SimpleNamespace(design=SimpleNamespace(terms=())), ()
    found: Any = SimpleNamespace(ranking=())
    other, _ = reversals.taken(so_far, found, SimpleNamespace(runs=()), ())  # type: ignore[arg-type]
    assert other.names == {BUILT.name}
    assert asked == tried


@pytest.mark.parametrize("late", [0.0, 1e-4])
def test_later_looks_are_at_the_torque_as_it_was_brought_forward(late: float, monkeypatch: pytest.MonkeyPatch) -> None:
    def campaign(name: str, late_torque: float) -> Any:
        look = SimpleNamespace(late_torque=late_torque, late_motor=False)
        return SimpleNamespace(name=name, runs=[SimpleNamespace(look=look)])

    def standing(of: Any) -> Any:
        return SimpleNamespace(p=SimpleNamespace(campaign=of))

    asked: list[str] = []
    first = SimpleNamespace(
        wanted=lambda s: True, taken=lambda s, found, of, hold_out: (standing(campaign("anew", late)), found)
    )

    def second(s: Any, found: Any, of: Any, hold_out: Any) -> tuple[Any, Any]:
        asked.append(of.name)
        return s, found

    monkeypatch.setattr(looks, "LOOKS", (first, SimpleNamespace(wanted=lambda s: True, taken=second)))
    before: Any = campaign("as read", 0.0)
    nothing: Any = None
    looks.second_looks(standing(before), nothing, before, ())
    assert asked == ["anew" if late else "as read"]
