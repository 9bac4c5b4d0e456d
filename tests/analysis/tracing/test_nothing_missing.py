"""Campaigns with nothing hidden, by the independent plant: nothing is said to be missing, whatever was not measured."""

from pathlib import Path

import pytest

from rig.analysis.tracing.outcome.result import Status
from rig.analysis.tracing.trace import trace
from tests.blind.cases import Request
from tests.blind.generate import write_case


@pytest.mark.long
@pytest.mark.parametrize("plan", ["no_torque_sensor", "one_direction"])
def test_nothing_is_missing_from_a_rig_that_is_the_papers(tmp_path: Path, plan: str) -> None:
    write_case(Request("clean", 5, plan), tmp_path, "case")
    verdict = trace(tmp_path / "case").verdict
    assert (verdict.status, verdict.effects) == (Status.NOTHING, ())
