"""Friction that builds up over milliradians shows where no equation holds, and is named all the same."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.looks import reversals
from rig.analysis.tracing.runs import building_up
from rig.analysis.tracing.runs.building_up import WAYS, builds_up
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.slow
@pytest.mark.long
def test_what_is_done_with_before_the_equations_begin_is_named(tmp_path: Path) -> None:
    write_case(Request("single", 11, "paper", "presliding_friction", "dahl", 4.0), tmp_path, "case")
    hidden = json.loads((tmp_path / "truth" / "case.json").read_text())["hidden"][0]["parameters"]
    found = trace(tmp_path / "case")
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("presliding_friction",))
    x_0 = next(p for e in found.effects for p in e.parameters if p.name == "x_0")
    assert x_0.value == pytest.approx(hidden["distance_rad"], rel=0.03)
    before, after = (ratios["tau_m_at_reversals"] for ratios in (found.ratios_before, found.ratios_after))
    assert (before > 5.0, after < 1.3) == (True, True)


@pytest.mark.slow
@pytest.mark.long
def test_lock_tests_alone_show_it_as_well(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_case(Request("single", 11, "paper", "presliding_friction", "dahl", 1.5), tmp_path, "case")
    assert builds_up(read_campaign(tmp_path / "case").runs) == (False, True)
    monkeypatch.setattr(reversals, "builds_up", lambda runs: (True,))
    assert trace(tmp_path / "case").verdict.effects == ("presliding_friction",)


@pytest.mark.slow
def test_friction_that_jumps_builds_up_over_no_way(shared: Path) -> None:
    assert not builds_up(read_campaign(shared / "cases" / "open-1").runs)


free: Any = SimpleNamespace(locked=False)


def left(*over: float) -> np.ndarray[Any, Any]:
    """Squares that a jump and each of the ways leave; the first ways as given, RMS, the others as much as the jump."""
    return np.square([1.0, *over, *[1.0] * (len(WAYS) - len(over))])


@pytest.mark.parametrize(
    ("runs", "shown"),
    [
        ([left(0.7, 0.4, 0.7)] * 3 + [left(1.0, 0.9, 1.0)], True),  # noise, or a large load, hides it in one
        ([left(0.7, 0.4, 0.7), *[left(1.0, 0.97, 1.0)] * 3], False),
        ([left(0.4, 0.9, 1.5), left(1.5, 0.9, 0.4)], False),  # no way that all have
        ([left(*np.linspace(1.0, 0.3, len(WAYS)))] * 3, False),  # longer than the longest: the equations see it
        ([left(0.7, 0.4, 0.7) * 0.01, left() * 100.0], False),  # what is left where nothing is lost counts as little
        ([], False),
    ],
)
def test_all_runs_together_have_to_show_one_way(
    monkeypatch: pytest.MonkeyPatch, runs: list[np.ndarray[Any, Any]], shown: bool
) -> None:
    told = iter([(squares, 2) for squares in runs])
    monkeypatch.setattr(building_up, "_at_reversals", lambda run: next(told))
    assert builds_up([free] * len(runs)) == ((False,) if shown else ())


def test_runs_that_turn_and_lock_tests_are_asked_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    shows, hides = left(0.7, 0.4, 0.7), left(1.0, 0.97, 1.0)
    monkeypatch.setattr(building_up, "_at_reversals", lambda run: (shows if run.locked else hides, 2))
    held: Any = SimpleNamespace(locked=True)
    assert builds_up([free, free, held]) == (True,)
    assert builds_up([free]) == ()


def test_one_reversal_says_so_where_hardly_anything_is_left_or_a_lock_test_says_it_too(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Half a slow triangle has one: the other half is held out (exam 105, case 16)."""
    held: Any = SimpleNamespace(locked=True)

    def told(of_free: float, of_locked: float) -> tuple[bool, ...]:
        found = {False: left(0.9, of_free, 0.9), True: left(0.9, of_locked, 0.9)}
        monkeypatch.setattr(building_up, "_at_reversals", lambda run: (found[run.locked], 1))
        return builds_up([free, held])

    assert told(0.15, 0.9) == (False,)
    assert told(0.45, 0.9) == ()
    assert told(0.45, 0.5) == (False, True)
