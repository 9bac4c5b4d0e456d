"""A delay that shows in the zeros of runs alone is named where they lie on a line over the speed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.fit.equations import Term
from rig.analysis.tracing.fit.model import design, fit
from rig.analysis.tracing.floor.homed import about_a_line
from rig.analysis.tracing.floor.offsets import of_effects
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.trace import trace
from rig.model.effects import LIBRARY
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.slow
@pytest.mark.long
def test_a_load_angle_read_late_is_named_though_every_run_has_a_zero_of_its_own(tmp_path: Path) -> None:
    write_case(Request("single", 7, "paper_once", "channel_time_skew", "load_late", 3.0), tmp_path, "case")
    hidden = json.loads((tmp_path / "truth" / "case.json").read_text())["hidden"][0]["parameters"]
    found = trace(tmp_path / "case")
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("channel_time_skew",))
    late = found.effects[0].parameters[0]
    assert (late.name, late.value) == ("skew_theta_l", pytest.approx(hidden["late_s"], rel=0.3))


@pytest.mark.slow
@pytest.mark.long
def test_zeros_that_follow_no_speed_are_every_runs_own(shared: Path) -> None:
    p = prepare(read_campaign(shared / "cases" / "open-1"), ())
    assert about_a_line(p.baseline) is None
    # a wave in the motor angle shifts a run that goes a part of a turn, and hardly one that goes round
    s = fit(design(p.eq, (Term(LIBRARY["motor_encoder_eccentricity"], ()),), p.split.fitted))
    s.x[s.design.place(0)] = 1e-3  # rad
    by = {p.eq.runs[i].name: abs(of_effects(s, i, "A")) for i, c in s.keys if c == "A"}
    assert max(x for name, x in by.items() if name.startswith("speed")) < 2e-6
    assert by["lock_20_1"] > 5e-5
