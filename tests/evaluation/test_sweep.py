"""What an operator gets of a sweep: a table in the terminal and the summary, result.json, a page."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from rig.evaluation.afterwards import to_depths, to_load_law
from rig.evaluation.sweep import runs_of
from tests.analysis.across_runs.test_assembly_band import swept

pytestmark = pytest.mark.xdist_group("sweep report")  # what the module makes is made once, not for every worker


def made(folder: Path) -> Path:
    """A campaign folder as far as a sweep's report reads it."""
    (folder / "summary.txt").write_text("campaign\n")
    for k, run in enumerate(swept(5, scatter=0.004, per_mm=0.5)):
        about = {"tau_ext": run.load, "depth_mm": run.depth_mm, "assembly": run.assembly, "note": "load sweep, up"}
        manifest = {
            "schema": "hdrig.run/1", "procedure": "kinematic_error", "status": "completed", "backend": "sim",
            "gear": {"ratio": 50.0, "serial": "A1"}, "conditions": about, "uid": f"{k:04d}",
        }  # fmt: skip
        size = run.peak_to_peak
        estimate = {"label": "p-p", "value": size.value, "unit": "arcsec", "ci95": [size.low, size.high], "how": ""}
        (folder / f"{k:02d}").mkdir()
        (folder / f"{k:02d}" / "manifest.json").write_text(json.dumps(manifest))
        result = {"schema": "hdrig.result/1", "estimates": {"kinematic_error_peak_to_peak": estimate}}
        (folder / f"{k:02d}" / "result.json").write_text(json.dumps(result))
    return folder


@pytest.fixture(scope="module")
def swept_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("sweep"))


def silent(text: str) -> None:
    """Nobody asks for progress."""


@pytest.mark.slow
def test_an_assembly_sweep_ends_with_every_depth_and_the_band(swept_folder: Path) -> None:
    made = to_depths(swept_folder, silent)
    assert made.exit == 0
    said = "\n".join(made.lines)
    head = next(line for line in made.lines if "N·m" in line and "band of one fitting" in line)
    assert head.split()[:4] == ["N·m", "reference", "+0.15", "mm"]
    assert "Re-assembly at one depth, 1 σ" in said
    assert "* differs from the reference depth by more than fitting the wave generator anew does" in said
    assert "SIMULATED" in said
    assert "band of one fitting" in (swept_folder / "summary.txt").read_text()
    data = json.loads((swept_folder / "result.json").read_text())
    assert data["procedure"] == "assembly_sweep"
    assert data["estimates"]["reproducibility"]["unit"] == "%"
    assert len(data["tables"]["assembly"]) == 12
    page = (swept_folder / "report.html").read_text()
    for words in ("Kinematic error and assembly depth", "SIMULATED", "Peak to peak against load", "tinted band"):
        assert words in page
    assert len(runs_of(swept_folder)) == 20, "the campaign's own result is none of its runs"


def test_a_load_sweep_ends_with_its_law_and_a_page(swept_folder: Path) -> None:
    made = to_load_law(swept_folder, silent)
    assert made.exit == 0
    assert any("P(T) = P_∞" in line for line in made.lines)
    assert json.loads((swept_folder / "result.json").read_text())["procedure"] == "load_sweep"


def test_a_run_whose_figures_do_not_count_is_no_part_of_a_sweep(tmp_path: Path) -> None:
    path = made(tmp_path) / "03" / "result.json"
    result = json.loads(path.read_text())
    result["estimates"]["kinematic_error_peak_to_peak"]["counts"] = False
    path.write_text(json.dumps(result))
    assert len(runs_of(tmp_path)) == 19


def test_a_sweep_of_which_nothing_was_analysed_says_so(tmp_path: Path) -> None:
    made = to_depths(tmp_path, silent)
    assert made.exit == 6
    assert "no run of the sweep was analysed" in made.lines[0]
