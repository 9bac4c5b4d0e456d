"""A line that was taken for a vibration of the load beside effects that do not stand is asked for again."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest

from rig.analysis.tracing import searched
from rig.analysis.tracing.searched import _own_as_it_stands as own_as_it_stands


@dataclass(frozen=True)
class Prepared:
    """As much of it as is asked."""

    own: Any
    held_out: Any


@dataclass(frozen=True)
class HeldOut:
    """As much of it as is asked."""

    calm: bool


@dataclass(frozen=True)
class Found:
    """As much of it as is asked."""

    solution: Any


def solution(*names: str) -> Any:
    return SimpleNamespace(design=SimpleNamespace(terms=tuple(SimpleNamespace(name=name) for name in names)))


def own(*names: str) -> Any:
    return SimpleNamespace(made=dict.fromkeys(names), jumped=None)


@pytest.mark.parametrize(("tried", "made", "stands", "beside_it", "again"), [
    ("lost_motion", ("external_vibration",), (), (), True),  # the lost motion is gone, and with it the vibration
    ("lost_motion", ("external_vibration",), (), ("external_vibration",), False),
    ("lost_motion", ("external_vibration",), ("lost_motion",), (), False),  # what it was found beside stands
    ("lost_motion", ("missed_counts",), (), (), False),
    ("missed_counts", (), (), ("missed_counts",), True),  # none are lost on and on, and a step is looked for
    ("missed_counts", (), (), (), False),
    ("missed_counts", (), ("missed_counts",), ("missed_counts",), False),
])  # fmt: skip
def test_it_is_selected_anew_where_beside_what_stands_runs_have_another_thing_to_themselves(
    monkeypatch: pytest.MonkeyPatch,
    tried: str,
    made: tuple[str, ...],
    stands: tuple[str, ...],
    beside_it: tuple[str, ...],
    again: bool,
) -> None:
    fresh = Prepared(own(*beside_it), HeldOut(False))
    monkeypatch.setattr(searched, "beside", lambda p, s, covered: (fresh, solution(*stands)))
    monkeypatch.setattr(searched, "select", lambda p, found, runs, covered: ("anew", p.held_out.calm))
    selected: Any = SimpleNamespace(p=Prepared(own(*made), HeldOut(True)), solution=solution(*stands))
    found: Any = Found(solution(tried))
    nothing: Any = None
    out: Any = own_as_it_stands(selected, found, (), nothing)
    assert out == ("anew", True) if again else out is selected
