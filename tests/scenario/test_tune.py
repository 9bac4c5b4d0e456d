"""`hdrig tune` on the twin: where the default gains do not turn the motor evenly, the gains it finds do."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from rig.cli import main
from tests.scenario.test_slow_run import SHORT, run_of

STICKY = ["--set", "twin.omega_s=1.5"]  # 9.6 rpm = 1 rad/s then lies on the steepest part of the Stribeck curve


@pytest.mark.slow
@pytest.mark.long
def test_default_gains_hunt_at_a_stribeck_speed_of_1_5_and_the_run_is_rejected_with_advice(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", "kinematic-error", "--out", str(tmp_path), *STICKY, *SHORT]) == 6
    out = capsys.readouterr().out
    assert "\nINCONCLUSIVE: " in out
    assert re.search(r"speed scatter \d+\.\d % of 9\.60 rpm \(limit 10 %\)", out)
    assert "hdrig tune" in out
    assert json.loads((run_of(tmp_path) / "manifest.json").read_text())["status"] == "completed"


@pytest.mark.slow
@pytest.mark.parametrize(
    "omega_s", [pytest.param(0.3, marks=pytest.mark.long), 1.5, pytest.param(4.0, marks=pytest.mark.long)]
)
def test_the_gains_it_finds_give_a_smooth_slow_run(
    omega_s: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stribeck, tuned = ["--set", f"twin.omega_s={omega_s}"], tmp_path / "tuned.toml"
    assert main(["tune", *stribeck, "--out", str(tmp_path / "tuning"), "--write", str(tuned)]) == 0
    out = capsys.readouterr().out
    assert "before: Kp 3 " in out
    assert re.search(r"after: .*stuck 0\.0 %, speed scatter [0-4]\.\d %", out)
    assert main(["run", "kinematic-error", "--bench", str(tuned), "--out", str(tmp_path / "runs"), *SHORT]) == 0
    result = json.loads((run_of(tmp_path / "runs") / "result.json").read_text())
    assert result["estimates"]["speed_scatter"]["value"] < 5.0


@pytest.mark.slow
def test_a_trial_that_trips_ends_the_tuning_as_tripped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["tune", "--set", "limits.twist_deg=0.012", "--out", str(tmp_path)]) == 5
    assert "the trial was ended: motor and load disagree" in capsys.readouterr().err


def test_a_file_that_exists_is_not_overwritten(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    taken = tmp_path / "bench.toml"
    taken.write_text("mine")
    assert main(["tune", "--write", str(taken), "--out", str(tmp_path)]) == 2
    assert "exists already" in capsys.readouterr().err
    assert taken.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [taken]
