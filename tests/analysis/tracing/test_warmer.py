"""Friction that warms, asked for beside what explains everything above the floor."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing import searched

DRIFT = searched.DRIFT


def selected(*names: str, loud: bool = False) -> Any:
    s = SimpleNamespace(design=None)
    return SimpleNamespace(
        names=set(names), loud=loud, taken=frozenset(), solution=s, p=SimpleNamespace(held_out="first")
    )


@pytest.mark.parametrize(
    ("scatter", "evidence", "before", "loud", "after", "certain", "counts"),
    [
        (4.7, 107.0, ("crosstalk",), False, ("crosstalk", DRIFT), True, True),
        (4.7, 107.0, ("crosstalk",), False, ("crosstalk", DRIFT), False, False),
        (0.6, 107.0, ("crosstalk",), False, ("crosstalk", DRIFT), True, False),  # repeats differ by no friction
        (4.7, 107.0, ("crosstalk",), False, (DRIFT,), True, False),  # takes another one's name
        (4.7, 20.0, ("crosstalk",), False, ("crosstalk", DRIFT), True, False),  # hardly any evidence
        (4.7, 107.0, (), False, (DRIFT,), True, False),  # by itself it is asked for elsewhere
        (4.7, 107.0, ("crosstalk",), True, ("crosstalk", DRIFT), True, False),  # something is left: asked for there
    ],
)
def test_it_counts_where_it_is_as_certain_as_by_itself(
    monkeypatch: pytest.MonkeyPatch,
    scatter: float,
    evidence: float,
    before: tuple[str, ...],
    loud: bool,
    after: tuple[str, ...],
    certain: bool,
    counts: bool,
) -> None:
    other, nothing = selected(*after), None
    asked: list[Any] = []
    monkeypatch.setattr(searched, "refine", lambda *_: (None, None))
    monkeypatch.setattr(searched, "settled", lambda *_: None)
    again = SimpleNamespace(held_out=SimpleNamespace(calm=False))
    monkeypatch.setattr(searched, "beside", lambda *_: (again, None))
    monkeypatch.setattr(searched, "replace", lambda of, **changed: SimpleNamespace(**{**vars(of), **changed}))
    monkeypatch.setattr(searched, "select", lambda p, *_: asked.append(p.held_out.calm) or other)
    monkeypatch.setattr(searched, "is_certain", lambda one, floors: certain and floors == "first")
    ranking = [SimpleNamespace(term=SimpleNamespace(name=DRIFT), evidence=evidence)]
    found: Any = SimpleNamespace(ranking=ranking)
    stands = selected(*before, loud=loud)
    stands.p.measured = SimpleNamespace(
        friction=SimpleNamespace(square=scatter**2), noise=SimpleNamespace(sigma={"M": 4.0})
    )
    got = searched._warmer(stands, found, (), nothing)  # type: ignore[arg-type]
    assert (got is other) is counts
    assert asked in ([], [True])
