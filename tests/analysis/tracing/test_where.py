"""Where what is left lives: in fitted runs, or in all of them where those tell of nothing."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.in_the_floor import as_runs_begin
from rig.analysis.tracing.selection import where
from rig.analysis.tracing.selection.where import _in_the_floor_too as in_the_floor_too
from rig.analysis.tracing.selection.where import _left as left


@pytest.mark.parametrize(("share", "first", "waves"), [(1.0, True, False), (1.0, False, True), (0.5, True, True)])
def test_what_settles_in_every_run_is_no_wave_that_comes_back_with_the_runs(
    monkeypatch: pytest.MonkeyPatch, share: float, first: bool, waves: bool
) -> None:
    wave = Home("time_periodic", "A", 0.6, frequency_hz=0.03)
    monkeypatch.setattr(where, "in_the_floor", lambda *asked: wave)
    settles = Home("time", "A", share, first=first)
    p: Any = SimpleNamespace(eq=None)
    assert in_the_floor_too(p, [settles], {}, {}, {}) == ([wave, settles] if waves else [settles])


@pytest.mark.parametrize(
    ("begun", "hz", "with_the_runs"),
    [
        ([308, 378, 448, 728, 798, 868], 1 / 69.5, True),
        ([308, 378, 448, 728, 798, 868], 0.033, False),  # it goes round more than twice from one to the next
        ([308, 388, 430, 728, 805, 868], 1 / 69.5, False),  # they begin when they like
        ([308, 378, 448], 1 / 69.5, False),  # too few
    ],
)
def test_a_wave_that_is_at_the_same_point_whenever_a_run_begins_is_what_runs_do(
    begun: list[int], hz: float, with_the_runs: bool
) -> None:
    quiet = [1004, 1021]
    eq: Any = SimpleNamespace(runs=[SimpleNamespace(start=float(t)) for t in (*begun, *quiet)])
    e = {(i, "A"): np.full(9, 4.0 if i < len(begun) else 1.0) for i in range(len(eq.runs))}
    wave = Home("time_periodic", "A", 0.6, frequency_hz=hz)
    assert as_runs_begin(eq, e, dict.fromkeys(e, 1.0), wave) is with_the_runs


@pytest.mark.parametrize(
    ("fitted", "unseen", "theirs"),
    [(1.0, 3.0, False), (1.2, 3.0, True), (1.0, 1.3, True)],  # times the floor
)
def test_what_fitted_runs_tell_nothing_of_is_looked_for_in_all(
    fitted: float, unseen: float, theirs: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    def solution(runs: tuple[int, ...]) -> Any:
        keys = [(run, "A") for run in runs]
        made = SimpleNamespace(eq=None, terms=())
        return SimpleNamespace(keys=keys, design=made, residual=lambda key: np.full(5, fitted))

    p: Any = SimpleNamespace(
        split=SimpleNamespace(fitted=(0, 2), held_out=(1,)), held_out=SimpleNamespace(floors={(1, "A"): 1.0})
    )
    monkeypatch.setattr(where, "design", lambda eq, terms, runs: runs)
    monkeypatch.setattr(where, "fit", solution)
    found, floors, own = left(p, solution((0, 2)), {(0, "A"): 1.0, (2, "A"): 1.0}, unseen)
    assert own == theirs
    assert sorted(run for run, _ in found) == ([0, 2] if theirs else [0, 1, 2])
    assert found.keys() == floors.keys()
