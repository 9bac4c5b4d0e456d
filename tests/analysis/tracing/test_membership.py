"""Which runs of a folder are traced together, and when they were taken."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis.tracing.runs import campaign
from rig.analysis.tracing.runs.membership import one_rig, starts
from rig.analysis.tracing.runs.told_once import left_out as left_out_of
from rig.core.errors import UsageError


def run(name: str, number: int = 1, rig_time: float | None = None, status: str = "completed", **conditions: Any) -> Any:
    campaign = {"uid": "c", "run": number} | ({} if rig_time is None else {"rig_time_s": rig_time})
    return SimpleNamespace(
        name=name, conditions=conditions, started=None, manifest={"status": status, "campaign": campaign}
    )


def test_the_assembly_most_runs_were_taken_in_is_kept_and_the_rest_told() -> None:
    runs = [run("a", 1, assembly=1), run("b", 2, assembly=2, depth_mm=0.15), run("c", 3, assembly=1)]
    kept, notes = one_rig(runs)
    assert [r.name for r in kept] == ["a", "c"]
    assert notes == ["1 runs of other assemblies or depths than assembly 1 at 0.0 mm were left out."]


def test_an_attempt_that_tripped_gives_way_to_the_one_that_was_completed() -> None:
    runs = [run("first", 4, status="tripped"), run("again", 4), run("alone", 5, status="stopped")]
    kept, notes = one_rig(runs)
    assert [r.name for r in kept] == ["again", "alone"]
    assert notes == ["first (tripped) was left out: the campaign made it again."]


def test_runs_without_a_campaign_are_kept_as_they_are() -> None:
    bare = SimpleNamespace(name="x", conditions={}, started=None, manifest={"status": "stopped"})
    assert one_rig([bare]) == ([bare], [])


def test_the_rig_s_own_time_counts_where_the_campaign_says_it_of_every_run() -> None:
    assert starts([run("a", 1, 20.0), run("b", 2, 620.0)]) == [0.0, 600.0]
    assert starts([run("a", 1, 20.0), run("b", 2)]) == [0.0, 0.0]


@pytest.mark.parametrize(("turns", "locked", "left_out"), [(0.4, False, True), (0.4, True, False), (1.2, False, False)])
def test_a_run_whose_motor_makes_no_turn_is_left_out_unless_its_output_is_held(
    turns: float, locked: bool, left_out: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    piece = SimpleNamespace(theta_m=np.linspace(0.0, 2 * np.pi * turns, 50))
    made = SimpleNamespace(
        pieces=(piece,),
        locked=locked,
        input_locked=False,
        procedure="kinematic_error",
        has=frozenset[str](),
        ratio=50.0,
    )
    monkeypatch.setattr(campaign, "record", lambda run, start, hz, look: made)
    found = campaign._record(cast(Any, SimpleNamespace(name="jog", path=Path("jog"), manifest={})), 0.0)
    assert (
        found == left_out_of("jog", "its motor went 0.40 of a turn, a kinematic error needs a whole one")
    ) is left_out


def test_a_folder_of_campaigns_is_told_from_a_campaign(tmp_path: Path) -> None:
    run = tmp_path / "campaign-a" / "run-1"
    run.mkdir(parents=True)
    (run / "manifest.json").write_text("{}")
    with pytest.raises(UsageError, match=r"holds no run.*campaign-a in it does"):
        campaign.read_campaign(tmp_path)


def test_runs_laid_by_the_day_are_one_campaign(tmp_path: Path) -> None:
    runs = [tmp_path / "2026-11-20" / "run-1", tmp_path / "2026-11-21" / "run-2"]
    for run in runs:
        run.mkdir(parents=True)
        (run / "manifest.json").write_text("{}")
    assert campaign.folders_of_runs(tmp_path) == runs
