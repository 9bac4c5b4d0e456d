"""Whatever coordinate an unknown rest lives in, the run that the report asks for is one this rig can make."""

from __future__ import annotations

import pytest

from rig.analysis.tracing.residual.home import SIMPLE
from rig.analysis.tracing.selection.next_run import along
from rig.bench import read
from rig.campaign.plan import parse_plan
from rig.campaign.planner import planned
from rig.closing.advice import plan_for, sections
from tests.closing.test_loop import PLAN


@pytest.mark.parametrize("coordinate", SIMPLE)
def test_there_is_a_run_along_every_coordinate(coordinate: str) -> None:
    asked = along(coordinate)
    assert asked is not None
    assert coordinate.replace("_", " ") in asked.because
    made = planned(plan_for(sections(asked), parse_plan(PLAN, "small.toml")), read("twin"), 1)
    assert len(made.items) >= 2
