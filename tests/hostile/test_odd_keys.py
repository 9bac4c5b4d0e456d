"""Any value of any key a campaign's manifests may have: identification and trace read the runs, or say why not."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from rig.analysis.tracing.runs.campaign import read_campaign
from rig.core.errors import HdrigError, UsageError
from rig.evaluation.to_identify import open_runs
from tests.commands.made_run import made_run
from tests.some import some

ODD: list[Any] = [[], {}, "abc", True, None, math.nan, 10**400]
KEYS = (
    "gear.serial", "gear.output", "conditions.assembly", "conditions.depth_mm", "conditions.tau_ext",
    "conditions.output_locked", "conditions.speed_rpm", "declared.K", "encoders.motor_counts_per_rev", "campaign",
    "campaign.uid", "campaign.run", "campaign.rig_time_s", "started_utc", "status", "loop", "limits", "label", "rows",
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("key", some(KEYS, 3))
def test_a_campaign_with_one_odd_key_is_read_or_refused_in_a_sentence(key: str, tmp_path: Path) -> None:
    table, _, name = key.rpartition(".")
    good = made_run(tmp_path / "good")
    for number, odd in enumerate(ODD):
        folder = tmp_path / str(number)
        folder.mkdir()
        base = {"gear": {"ratio": 50.0, "serial": "A1"}}.get(table, {})
        run = made_run(folder / "odd", {table: {**base, name: odd}} if table else {name: odd})
        made_run(folder / "good")
        for read in (lambda: open_runs([good, run], lambda text: None), lambda: read_campaign(folder)):  # noqa: B023
            try:
                read()
            except HdrigError as error:
                assert len(str(error)) > 20


@pytest.mark.parametrize("assembly", [[], {}, True])
def test_an_assembly_that_is_none_is_said_and_counts_as_the_first(assembly: Any, tmp_path: Path) -> None:
    good, odd = made_run(tmp_path / "good"), made_run(tmp_path / "odd", {"conditions": {"assembly": assembly}})
    runs, _, said = open_runs([good, odd], lambda text: None)
    assert [run.name for run in runs] == ["good", "odd"]
    assert len(said) == 1
    assert said[0].startswith("odd: manifest.json: conditions.assembly is ")
    assert any(note.startswith("odd: manifest.json: conditions.assembly") for note in read_campaign(tmp_path).notes)


def test_two_gears_are_refused_alike(tmp_path: Path) -> None:
    folders = [made_run(tmp_path / name, {"gear": {"ratio": 50, "serial": name}}) for name in ("A1", "B2")]
    said = rf"{tmp_path.name}: its runs are of 2 gears \(A1, B2\), expected one"
    with pytest.raises(UsageError, match=said):
        open_runs(folders, lambda text: None)
    with pytest.raises(UsageError, match=said):
        read_campaign(tmp_path)
