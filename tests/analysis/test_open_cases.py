"""Campaigns from an independent plant: every run analysed, and the slow ones against the truth."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from rig.analysis import analyse
from rig.runfile.run import Run

ARCSEC = 180.0 / np.pi * 3600.0
CASES = [f"open-{n}" for n in range(1, 7)]
LOADED = "open-2"  # its error shrinks under the load of its own friction: not what the truth's table lists


@pytest.mark.long
@pytest.mark.parametrize("case", CASES)
def test_every_run_of_a_campaign_has_figures_and_a_sentence(shared: Path, case: str) -> None:
    folders = sorted(p for p in (shared / "cases" / case).iterdir() if p.is_dir())
    assert len(folders) == 36
    for folder in folders:
        result = analyse(Run.open(folder))
        assert result.sentence.endswith("."), folder.name
        assert len(result.estimates) >= 2, folder.name
        for e in result.estimates:
            assert np.isfinite(e.value), (folder.name, e.name)


@pytest.mark.slow
@pytest.mark.parametrize("case", [c for c in CASES if c != LOADED])
def test_the_slow_runs_give_the_true_coefficients_within_their_uncertainty(shared: Path, case: str) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())[case]
    true = np.array(truth["kinematic_error_a_rad"][1:16] + truth["kinematic_error_b_rad"][1:16]) * ARCSEC
    for name in ("slow_ke_1", "slow_ke_2"):
        rows = analyse(Run.open(shared / "cases" / case / name)).tables["coefficients"]
        found = np.array([r["a_arcsec"] for r in rows] + [r["b_arcsec"] for r in rows], float)
        u = np.array([r["u_a"] for r in rows] + [r["u_b"] for r in rows], float)
        pull = (found - true) / u
        assert np.sqrt(np.mean(pull**2)) < 1.4
        assert np.abs(pull).max() < 4.5, "eleven degrees of freedom: Student's tails are long"
        assert u.max() < 0.12


@pytest.mark.slow
def test_the_lock_runs_give_the_true_stiffness_within_its_interval(shared: Path) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())
    for case in ("open-1", "open-4", "open-5", "open-6"):
        for name in ("lock_20_1", "lock_60_1"):
            result = analyse(Run.open(shared / "cases" / case / name))
            figure = next(e for e in result.estimates if e.name == "torsional_stiffness")
            assert figure.ci95[0] <= truth[case]["baseline"]["K"] <= figure.ci95[1]


def test_hysteresis_shows_as_a_loop_of_its_true_width(shared: Path) -> None:
    truth = json.loads((shared / "cases" / "TRUTH.json").read_text())["open-3"]
    force = truth["parameters"]["bw_k"] * truth["parameters"]["bw_xy"]
    expected = 2 * force / truth["baseline"]["K"] * ARCSEC / 60
    result = analyse(Run.open(shared / "cases" / "open-3" / "lock_20_1"))
    width = next(e for e in result.estimates if e.name == "hysteresis_loss").value
    assert abs(width - expected) < 0.1 * expected


def test_what_shakes_the_rig_is_seen_at_rest(shared: Path) -> None:
    result = analyse(Run.open(shared / "cases" / "open-6" / "standstill"))
    assert "7.99" in result.sentence or "8.00" in result.sentence
