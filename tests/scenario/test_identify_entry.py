"""One command from the rig to a gear file; the lock test of a campaign less the kinematic error of its slow run."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.cli import main
from rig.model import gearfile

PLAN = """schema = "hdrig.plan/1"
name = "identify"
on_failure = "continue"

[[step]]
procedure = "kinematic-error"
with = { cycles = 1.0 }

[[step]]
procedure = "friction"
with = { speeds_rpm = "60,300,500", seconds = 1.0, breakaways = 2 }

[[step]]
procedure = "constant-torque"
with = { speed_rpm = 200, revolutions = 25, settle = 1.0 }

[[step]]
procedure = "constant-torque"
with = { speed_rpm = -300, revolutions = 30, settle = 1.0 }

[[step]]
procedure = "stiffness-lock"
with = { cycles = 1, rate = 3.0, rates = [1.0] }
"""


# the campaign is made once, not once for every worker, and takes most of a minute
pytestmark = [pytest.mark.xdist_group("identify entry"), pytest.mark.long]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The campaign `hdrig run identify` makes, shortened."""
    base = tmp_path_factory.mktemp("identify")
    (base / "short.toml").write_text(PLAN)
    assert main(["campaign", str(base / "short.toml"), "--seed", "4", "--out", str(base / "runs")]) == 0
    return next((base / "runs").rglob("campaign.json")).parent


@pytest.mark.slow
def test_the_last_run_is_followed_by_a_gear_file_with_intervals_and_characteristics(folder: Path) -> None:
    gear = gearfile.read(folder / "gear.toml")
    assert gear.simulated
    for name in ("J_m", "J_l", "K", "B_sp", "tau_c", "F_cl"):
        assert gear.parameters[name].origin == "measured", name
        assert gear.parameters[name].half > 0.0, name
    K = gear.parameters["K"]
    assert abs(K.value - 7160.0) < 3.0 * K.half
    beside = gear.characteristics
    assert beside["tau_break"].value == pytest.approx(0.45, rel=0.4), "twice two ramps from rest"
    assert beside["hysteresis_loss"].half > 0.0
    assert beside["K1"].interval[0] < 7160.0 < beside["K1"].interval[1]
    assert {"K2", "K3", "lost_motion"} <= set(beside)


@pytest.mark.slow
def test_the_lock_test_of_a_campaign_names_the_slow_run_it_was_freed_by(folder: Path, tmp_path: Path) -> None:
    runs = {json.loads(p.read_text())["procedure"]: p.parent for p in folder.glob("*/manifest.json")}
    lock, slow = runs["stiffness_lock"], runs["kinematic_error"]
    said = json.loads((lock / "result.json").read_text())
    K = said["estimates"]["torsional_stiffness"]
    low, high = K["ci95"]
    assert low < 7160.0 < high
    assert (high - low) / 2 / K["value"] < 0.008, "±3 % and more without"
    assert f"less the kinematic error of {slow.name}" in said["sentence"]
    manifest = json.loads((lock / "manifest.json").read_text())
    assert manifest["campaign"]["session"] == 1
    manifest["campaign"]["session"] = 2  # taken up again: the encoders may have been off
    (tmp_path / "other").mkdir()
    for name in ("samples.parquet", "timing.json", "events.jsonl"):
        if (lock / name).exists():
            (tmp_path / "other" / name).write_bytes((lock / name).read_bytes())
    (tmp_path / "other" / "manifest.json").write_text(json.dumps(manifest))
    (tmp_path / slow.name).symlink_to(slow)
    assert main(["analyse", str(tmp_path / "other")]) == 0
    alone = json.loads((tmp_path / "other" / "result.json").read_text())
    assert "less the kinematic error" not in alone["sentence"]
    wide = alone["estimates"]["torsional_stiffness"]["ci95"]
    assert wide[1] - wide[0] > 4 * (high - low)


@pytest.mark.slow
def test_a_lock_test_of_a_campaign_taken_up_again_is_freed_where_a_proof_shows_one_zero(
    folder: Path, tmp_path: Path
) -> None:
    runs = {json.loads(p.read_text())["procedure"]: p.parent for p in folder.glob("*/manifest.json")}
    proof = next((folder / "checks").glob("*sign-and-scale*"))
    again = {runs["stiffness_lock"]: tmp_path / "lock", proof: tmp_path / "checks" / "proof"}
    for source, target in again.items():
        target.mkdir(parents=True)
        manifest = json.loads((source / "manifest.json").read_text())
        assert manifest["campaign"]["session"] == 1
        manifest["campaign"]["session"] = 2
        (target / "manifest.json").write_text(json.dumps(manifest))
        for name in ("samples.parquet", "timing.json", "events.jsonl"):
            (target / name).symlink_to(source / name)
    (tmp_path / runs["kinematic_error"].name).symlink_to(runs["kinematic_error"])
    assert main(["analyse", str(tmp_path / "lock")]) == 0
    said = json.loads((tmp_path / "lock" / "result.json").read_text())["sentence"]
    assert f"less the kinematic error of {runs['kinematic_error'].name}" in said
