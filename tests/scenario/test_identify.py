"""hdrig identify and hdrig simulate from the command line: report, gear file, figure, and refusals in a sentence."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from rig.cli import main
from rig.model import gearfile

SOME = ("slow_ke_1", "lock_20_1", "speed_200rpm_1", "speed_300rpm_1", "speed_400rpm_1", "speed_minus200rpm_1")


@pytest.fixture
def campaign(shared: Path, tmp_path: Path) -> Path:
    for name in SOME:
        (tmp_path / "c").mkdir(exist_ok=True)
        (tmp_path / "c" / name).symlink_to(shared / "cases" / "open-1" / name)
    return tmp_path / "c"


@pytest.mark.slow
def test_a_campaign_becomes_a_gear_file_that_simulate_takes(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target, picture = tmp_path / "gear.toml", tmp_path / "fig11.svg"
    paths = [str(campaign / name) for name in SOME]
    assert main(["identify", *paths, "-o", str(target)]) == 0
    said = capsys.readouterr().out
    assert "torsional stiffness" in said
    assert "note: B_m and B_ml" in said
    file = gearfile.read(target)
    assert file.parameters["K"].value == pytest.approx(7199.6, rel=1e-3)
    assert file.parameters["K"].origin == "measured"
    assert set(file.parameters["J_l"].runs) == {n for n in SOME if n.startswith("speed")}
    assert main(["simulate", str(target), "--speed", "300", "--out", str(picture)]) == 0
    table = capsys.readouterr().out
    assert table.startswith("SIMULATED")
    assert "±" in next(line for line in table.splitlines() if line.strip().startswith("θ̃ p-p"))
    assert picture.read_text().startswith("<svg")
    assert "SIMULATED" in picture.read_text()


def test_simulate_takes_the_twin_and_a_constant_torque(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "fig.html"
    assert main(["simulate", "twin", "--torque", "0.4237", "--out", str(page)]) == 0
    said = capsys.readouterr().out
    row = next(line for line in said.splitlines() if line.strip().startswith("motor speed, rpm"))
    assert float(row.split()[-1]) == pytest.approx(300, abs=1)
    assert "nothing was measured" in said
    assert "<svg" in page.read_text()


@pytest.mark.slow
def test_simulate_says_which_torque_starts_the_gear_from_rest(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["simulate", "twin", "--start", "0.4", "0.6"]) == 0  # it slides at 0.3 N·m and breaks away at 0.5 N·m
    said = capsys.readouterr().out
    rows = {line.split()[0]: line.split() for line in said.splitlines()[2:4]}
    assert rows["0.4"][1:4] == ["no", "it", "does"]
    assert rows["0.6"][1] == "yes"
    assert float(rows["0.6"][2]) == pytest.approx(807, abs=5)
    assert said.startswith("SIMULATED")
    assert "breakaway was not measured (tau_s 0.5 N·m declared)" in said


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["simulate", "none"], "no bench called 'none'"),
        (["simulate", "twin", "--torque", "0.2"], "do not keep the gear turning"),
        (["simulate", "twin", "--speed", "0"], "--speed 0 rpm: expected a mean speed of the motor in rpm"),
        (["simulate", "twin", "--out", "fig.png"], "ends in .svg or .html"),
        (["simulate", "twin", "--start", "0.6", "--out", "fig.svg"], "not with --start"),
        (["simulate", "twin", "--start", "nan"], "expected torques in N·m"),
        (["identify", "nowhere"], "does not exist"),
        (["identify", ".", "--terms", "0"], "expected 1 to 40 orders"),
    ],
)
def test_what_cannot_be_meant_is_one_sentence(
    arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) != 0
    error = capsys.readouterr().err
    assert said in error
    assert "internal error" not in error


def test_a_gear_file_that_exists_is_not_overwritten(
    campaign: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "gear.toml").write_text("mine")
    assert main(["identify", str(campaign / SOME[0]), "-o", str(tmp_path / "gear.toml")]) == 2
    assert "exists already" in capsys.readouterr().err
    assert (tmp_path / "gear.toml").read_text() == "mine"


def test_runs_of_two_gears_are_refused(shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, ratio in (("a", "50"), ("b", "51")):
        shutil.copytree(shared / "cases" / "open-1" / "standstill", tmp_path / name)
        manifest = tmp_path / name / "manifest.json"
        manifest.chmod(0o644)
        manifest.write_text(manifest.read_text().replace('"ratio": 50', f'"ratio": {ratio}'))
    assert main(["identify", str(tmp_path)]) == 6
    assert "2 gear ratios (50.0, 51.0)" in capsys.readouterr().err


def test_a_ratio_that_the_encoders_contradict_is_refused(
    shared: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(shared / "cases" / "open-1" / "speed_400rpm_1", tmp_path / "run")
    manifest = tmp_path / "run" / "manifest.json"
    manifest.chmod(0o644)
    manifest.write_text(manifest.read_text().replace('"ratio": 50', '"ratio": 51'))
    assert main(["identify", str(tmp_path)]) == 6
    said = capsys.readouterr().err
    assert "times as far as the load, the declared gear.ratio is 51" in said


@pytest.mark.slow
def test_a_lock_run_alone_is_not_enough_for_a_gear_file(shared: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """open-1 declares inertias and stiffness: without those nothing would stand in for them."""
    assert main(["identify", str(shared / "cases" / "open-1" / "lock_20_1")]) == 6
    said = capsys.readouterr().out
    assert "Not determined by these runs: J_m, J_l, " in said
    assert "J_l: it takes" in said
