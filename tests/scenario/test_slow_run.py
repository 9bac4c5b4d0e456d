"""The main job on the twin, end to end through the command line: run folder, figures against the truth, determinism."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

from rig.bench import read, twin_parameters
from rig.cli import main
from rig.runfile.verify import verify

pytestmark = pytest.mark.xdist_group("slow run")  # what the module makes is made once, not for every worker

SHORT = ["--with", "cycles=1", "--with", "amplitude_deg=720", "--with", "frequency=0.02"]  # 9.6 rpm, 51 s


def run_of(root: Path, procedure: str = "kinematic-error") -> Path:
    found = [p.parent for p in root.rglob("manifest.json") if procedure in p.parent.name]
    assert len(found) == 1, found
    return found[0]


@pytest.fixture(scope="module")
def slow_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("runs")
    assert main(["run", "kinematic-error", "--out", str(root), *SHORT]) == 0
    return run_of(root)


@pytest.mark.slow
def test_the_run_folder_is_complete_and_keeps_its_promises(slow_run: Path) -> None:
    names = {p.name for p in slow_run.iterdir()}
    assert {"manifest.json", "bench.toml", "journal-0001.arrows", "samples.parquet", "events.jsonl"} <= names
    assert {"timing.json", "result.json", "report.html"} <= names
    assert [f for f in verify(slow_run) if f.level == "error"] == []
    manifest = json.loads((slow_run / "manifest.json").read_text())
    assert manifest["status"] == "completed"
    assert manifest["backend"] == "sim"
    assert manifest["proof"]["ratio"] == pytest.approx(50.0, rel=0.01)


@pytest.mark.slow
def test_samples_are_one_a_millisecond_with_asked_and_applied_torque(slow_run: Path) -> None:
    table = pq.read_table(slow_run / "samples.parquet")
    t = table["t"].to_numpy()
    assert len(t) == pytest.approx(51_000, abs=3)
    assert np.allclose(np.diff(t), 1e-3, atol=1e-9)
    asked, applied = table["tau_ask"].to_numpy(), table["tau_applied"].to_numpy()
    assert np.max(np.abs(asked - applied)) <= 0.5 * 0.003 + 1e-12  # the drive's resolution
    assert table["flags"].to_numpy().min() & 1  # every row says it is simulated


@pytest.mark.slow
def test_the_largest_fourier_coefficients_are_those_of_the_plant(slow_run: Path) -> None:
    result = json.loads((slow_run / "result.json").read_text())
    gear = twin_parameters(read("twin").file).gear
    for row in result["tables"]["coefficients"]:
        n = int(row["order"])
        true = math.degrees(gear.kinematic_error.amplitude[n - 1]) * 3600
        if true > 3.0:
            assert row["C_arcsec"] == pytest.approx(true, abs=0.3), f"order {n}"
    peak = result["estimates"]["kinematic_error_peak_to_peak"]
    truth = math.degrees(gear.kinematic_error.peak_to_peak()) * 3600
    assert peak["ci95"][0] - 0.2 < truth < peak["ci95"][1] + 0.2


@pytest.mark.slow
@pytest.mark.long
def test_the_same_seed_gives_byte_identical_samples_and_another_does_not(tmp_path: Path) -> None:
    quick = ["--with", "cycles=1", "--with", "amplitude_deg=180", "--with", "frequency=0.08"]  # 9.6 rpm, 13 s
    for name, seed in (("one", "1"), ("same", "1"), ("other", "2")):
        assert main(["run", "kinematic-error", "--out", str(tmp_path / name), "--seed", seed, *quick]) in (0, 6)
    one, same, other = (run_of(tmp_path / n) / "samples.parquet" for n in ("one", "same", "other"))
    assert same.read_bytes() == one.read_bytes()
    assert other.read_bytes() != one.read_bytes()


@pytest.mark.slow
def test_analysing_again_gives_the_same_figures_and_leaves_the_samples_alone(slow_run: Path) -> None:
    before = {n: (slow_run / n).read_bytes() for n in ("result.json", "samples.parquet", "report.html")}
    assert main(["analyse", str(slow_run)]) == 0
    assert {n: (slow_run / n).read_bytes() for n in before} == before
    assert [f for f in verify(slow_run) if f.level == "error"] == []


@pytest.mark.slow
def test_a_run_that_sticks_is_rejected_with_the_number_and_the_gain_to_change(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weak = ["control.Kp=2.5", "control.Ki=5", "control.Kd=0.01", "twin.omega_s=1.5", "limits.following_deg=60"]
    settings = [word for change in weak for word in ("--set", change)]
    assert main(["run", "kinematic-error", "--out", str(tmp_path), *settings, *SHORT]) == 6
    out = capsys.readouterr().out
    assert re.search(r"stuck \d+\.\d % of the time \(limit 2 %\)", out)
    assert "raise Kd" in out


@pytest.mark.slow
def test_gains_too_weak_to_hold_the_reference_trip_with_the_way_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    weak = ["--set", "control.Kp=0.3", "--set", "control.Ki=1", "--set", "control.Kd=0.005"]
    assert main(["run", "kinematic-error", "--out", str(tmp_path), *weak, *SHORT]) == 5
    assert "behind its reference" in (err := capsys.readouterr().err)
    assert "hdrig tune" in err
