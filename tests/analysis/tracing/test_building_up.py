"""Friction that builds up over milliradians shows where no equation holds, and is named all the same."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.tracing.outcome.result import Status
from rig.analysis.tracing.runs import building_up
from rig.analysis.tracing.runs.building_up import JUMP, builds_up
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.slow
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
def test_friction_that_jumps_builds_up_over_no_way(shared: Path) -> None:
    assert not builds_up(read_campaign(shared / "cases" / "open-1").runs)


@pytest.mark.parametrize(
    ("ways", "shown"),
    [
        ([2e-3, 2e-3, 2.5e-3, JUMP], True),  # a large load hides it
        ([2e-3, JUMP, JUMP], False),
        ([2e-3, 2e-3, 7e-3, 7e-3], False),  # no way that all have
        ([], False),
    ],
)
def test_most_runs_have_to_show_one_way(monkeypatch: pytest.MonkeyPatch, ways: list[float], shown: bool) -> None:
    told = iter([(way, 2) for way in ways])
    monkeypatch.setattr(building_up, "_way", lambda run: next(told))
    runs: list[Any] = [None] * len(ways)
    assert builds_up(runs) is shown
