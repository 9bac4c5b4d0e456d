"""The run that is asked for takes part in the next fit."""

from __future__ import annotations

from pathlib import Path

import pytest

from rig.analysis.tracing.prepared import Prepared, prepare
from rig.analysis.tracing.runs.campaign import read_campaign
from rig.analysis.tracing.selection.expected import proposals
from rig.analysis.tracing.selection.next_run import _fitted
from tests.analysis.tracing.test_few_channels import reduced

RUNS = [f"{name}_{k}" for name in ("slow_ke", "speed_120rpm", "speed_300rpm", "speed_400rpm") for k in (1, 2)]

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("next run")]


@pytest.fixture(scope="module")
def prepared(shared: Path, tmp_path_factory: pytest.TempPathFactory) -> Prepared:
    folder = reduced(tmp_path_factory.mktemp("few"), shared / "cases" / "open-5", RUNS, ())
    return prepare(read_campaign(folder), ())


def test_what_is_measured_last_is_never_held_out_whole_and_a_repeat_of_it_tests_the_fit(prepared: Prepared) -> None:
    by_speed = {
        q.conditions["speed_rpm"]: _fitted(prepared, q)
        for q in proposals(prepared.eq.runs[0].pieces[0].dt)
        if q.procedure == "constant_torque"
    }
    assert all(share > 0.0 for share in by_speed.values()), "a speed between others too"
    assert by_speed[60.0] == 0.5, "the slowest: its repeat tests the fit"
