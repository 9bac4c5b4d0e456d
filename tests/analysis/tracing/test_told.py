"""What trace.json says of the baseline's parameters: what each is, which did not move and why; how it is written."""

from __future__ import annotations

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest

from rig.analysis.tracing.outcome import record
from rig.analysis.tracing.outcome.record import document, write_trace
from rig.analysis.tracing.outcome.told import meaning, unmoved, why_unmoved
from rig.model.effect import parameter
from tests.report.trace import made_up

BEFORE = (
    parameter("K", 7500.0, 40.0, "N·m/rad"),
    parameter("J_m", 1.6e-3, 1e-5, "kg·m²"),
    parameter("J_l", 0.88, 0.003, "kg·m²"),
    parameter("tau_cl", 0.46, 0.001, "N·m"),
    parameter("lag", 2e-6, 1e-5, "s"),
)
AFTER = (parameter("K", 7517.0, 0.3, "N·m/rad"), parameter("J_m", 1.6e-3, 8e-6, "kg·m²"), *BEFORE[2:])


def test_every_parameter_of_the_baseline_has_a_meaning_in_the_json() -> None:
    said = document(replace(made_up.explained(), baseline=BEFORE, baseline_after=AFTER))["baseline"]
    for where, stiffness in (("before_refit", 7500.0), ("parameters", 7517.0)):
        assert said[where]["K"]["meaning"] == "torsional stiffness, near zero torque"
        assert said[where]["K"]["value"] == stiffness
        assert all(entry["meaning"] for entry in said[where].values())
    assert meaning("theta_p_order_4") == "kinematic error, amplitude of order 4 of the motor angle"


def test_what_the_refit_could_not_move_is_said_with_the_reason() -> None:
    said = document(replace(made_up.explained(), baseline=BEFORE, baseline_after=AFTER))["baseline"]["not_moved"]
    assert said["parameters"] == ["J_l", "tau_cl", "lag"]  # J_m kept its value, its interval did not stay
    assert said["because"].startswith("J_l, τ_cl and t_r stand in the equation of the shaft torque alone")
    assert "could not move them" in said["because"]


def test_one_parameter_is_one_and_a_group_is_named_by_its_own_equation() -> None:
    effects = ["output_once_per_rev"]
    assert why_unmoved(BEFORE[2:3], BEFORE[2:3], effects).startswith("J_l stands in the equation of the shaft torque")
    assert "motor torque alone" in why_unmoved(BEFORE[1:2], BEFORE[1:2], effects)
    assert why_unmoved(BEFORE[:1], AFTER[:1], effects) == ""


def test_where_no_effect_was_added_nothing_was_fitted_again() -> None:
    assert why_unmoved(BEFORE, BEFORE, []) == "No effect was added, so nothing was fitted again."
    assert unmoved(BEFORE, BEFORE) == tuple(p.name for p in BEFORE)


def test_a_file_that_could_not_be_written_whole_leaves_the_old_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "trace.json"
    write_trace(path, made_up.explained())
    before = path.read_bytes()
    assert json.loads(before)["schema"] == "hdrig.trace/1"

    def torn(descriptor: int) -> None:
        raise OSError("the disk is gone")

    monkeypatch.setattr(os, "fsync", torn)
    with pytest.raises(OSError, match="the disk is gone"):
        write_trace(path, made_up.unknown())
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["trace.json"]


def test_what_stands_for_another_file_is_written_to_and_stays(tmp_path: Path) -> None:
    real, name = tmp_path / "real.json", tmp_path / "stdout"
    real.write_text("")
    name.symlink_to(real)
    write_trace(name, made_up.explained())
    assert name.is_symlink()
    assert json.loads(real.read_text())["schema"] == record.SCHEMA
