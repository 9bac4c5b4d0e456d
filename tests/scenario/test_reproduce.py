"""hdrig reproduce from a plan to the page, and again from what was recorded."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.cli import main
from rig.core.errors import Exit

PLAN = """
schema = "hdrig.plan/1"
name = "short"
[[step]]
procedure = "kinematic-error"
with = { cycles = 1, amplitude_deg = 720, frequency = 0.02 }
[[step]]
procedure = "constant-torque"
with = { speed_rpm = 300, revolutions = 20, settle = 2 }
[[step]]
procedure = "friction"
with = { speeds_rpm = "60,200,450", breakaways = 1 }
[[step]]
procedure = "kinematic-error"
with = { cycles = 1, amplitude_deg = 720, frequency = 0.02 }
weight = 7.5
"""


def rulings(folder: Path) -> dict[str, list[str]]:
    exhibits = json.loads((folder / "reproduction.json").read_text())
    return {e["number"]: [c["ruling"] for c in e["claims"]] for e in exhibits}


@pytest.mark.slow
@pytest.mark.long
def test_a_shortened_campaign_gives_the_figures_it_has_runs_for_and_dashes_for_the_rest(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    plan = tmp_path / "short.toml"
    plan.write_text(PLAN)
    assert main(["reproduce", "--plan", str(plan), "--out", str(tmp_path / "runs")]) == Exit.INCOMPLETE
    (campaign,) = (tmp_path / "runs").iterdir()
    found, out = rulings(campaign), capfd.readouterr().out
    assert found["Figure 2"] == ["holds"]
    assert found["Figure 6"] == ["holds"]
    assert found["Figure 9"][0] == "holds"  # falls with load
    assert found["Figure 11 b"] == ["holds"]  # by a gear identified from other runs
    assert set(found["Figure 10"] + found["Figure 13"] + found["Figure 7 a"]) == {"open"}
    assert out.startswith("SIMULATED")
    assert str(campaign / "reproduction.html") in out
    page = (campaign / "reproduction.html").read_text()
    assert "this run is none of them" in page
    again = tmp_path / "again"
    assert main(["reproduce", str(campaign), "--out", str(again)]) == Exit.INCOMPLETE
    assert rulings(again) == found


def test_a_folder_without_runs_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", str(tmp_path)]) == Exit.USAGE or "no completed run" in capsys.readouterr().err


def test_a_folder_that_is_none_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", str(tmp_path / "nowhere")]) == Exit.USAGE
    assert "is no folder" in capsys.readouterr().err
