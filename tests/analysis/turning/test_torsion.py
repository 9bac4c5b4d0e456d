"""Torsion against shaft torque, on a made gear and on a measured robot joint."""

from __future__ import annotations

import csv
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from rig.analysis import Result, analyse
from rig.analysis.motion.angle import unwrap
from rig.analysis.motion.source import Motion
from rig.analysis.turning.torsion import steady_part
from rig.core.units import TURN
from tests.analysis.synthetic import MadeRun, count

LARA8 = Path(__file__).parents[2] / "data" / "lara8" / "validate_joint3.csv"
COUNTS = 2.0**24


def figures(result: Result) -> dict[str, Any]:
    return {e.name: e for e in result.estimates}


@pytest.fixture(scope="module")
def joint3() -> Result:
    """Joint 3 of a robot arm, 298 degrees in one direction; the torque is computed, not measured (see SOURCE.md)."""
    with LARA8.open() as file:
        rows = list(csv.DictReader(file))

    def column(name: str) -> np.ndarray:
        return np.array([float(row[name]) for row in rows])

    columns = {
        "t": column("Timestamp") - float(rows[0]["Timestamp"]),
        "theta_m": unwrap(column("encoder_motorinc_3"), COUNTS) * TURN / COUNTS,
        "theta_l": unwrap(column("encoder_loadinc_3"), COUNTS) * TURN / COUNTS,
        "tau_l": column("target_joint_torque_3") - 0.8735 * column("fts_reading_1") - column("fts_reading_5"),
    }
    return analyse(MadeRun(columns, {"procedure": "other", "gear": {"ratio": 101, "output": "circular_spline"}}))


def test_the_measured_joint_has_an_apparent_stiffness_of_37_kilonewton_metres(joint3: Result) -> None:
    figure = figures(joint3)["torsional_stiffness_apparent"]
    assert abs(figure.value - 37_000) < 500
    assert figure.ci95[0] < 37_000 < figure.ci95[1]
    assert 0.1 < (figure.ci95[1] - figure.ci95[0]) / figure.value < 0.5, "one sweep does not repeat: tens of per cent"


def test_the_measured_joint_twists_by_18_arcmin_and_little_is_left(joint3: Result) -> None:
    assert abs(figures(joint3)["torsion_span"].value - 18.3) < 0.05
    assert abs(figures(joint3)["torsion_remainder_rms"].value - 0.17) < 0.005


def test_the_measured_joint_has_a_line_beside_order_two(joint3: Result) -> None:
    line = next(r for r in joint3.tables["torsion_lines"] if abs(float(r["order"]) - (2 - 2 / 101)) < 1e-9)
    assert abs(float(line["amplitude_arcsec"]) - 2.76) < 0.12
    assert line["resolved"] == "yes"


def test_the_measured_joint_cannot_tell_torsion_from_eccentricity_and_says_so(joint3: Result) -> None:
    assert any("cannot be separated" in s for s in joint3.cannot)
    assert any("One direction" in s or "one direction" in s for s in joint3.cannot)


def test_the_measured_joint_has_seventeen_rows_a_turn_so_the_series_is_short(joint3: Result) -> None:
    assert len(joint3.tables["coefficients"]) == 4
    assert any("too few per turn" in s for s in joint3.cannot)


def sweep(sign: float = 1.0, seed: int = 0) -> MadeRun:
    """Sixty turns at 60 rpm against a load that swings twice with no relation to the output angle."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, 60, 1e-3)
    theta_m = TURN * t
    tau = 12 * np.sin(0.55 * t) + 9 * np.sign(np.sin(0.9 * t)) + rng.normal(0, 0.05, t.size)
    theta_l = theta_m / 50 - tau / 7160.0
    columns = {"t": t, "theta_m": count(theta_m, 10_000), "theta_l": count(theta_l, 900_000), "tau_l": sign * tau}
    return MadeRun(columns, {"procedure": "constant_speed", "gear": {"ratio": 50}})


@pytest.mark.slow
def test_a_load_that_moves_freely_gives_the_stiffness_within_its_interval() -> None:
    figure = figures(analyse(sweep()))["torsional_stiffness_apparent"]
    assert figure.ci95[0] <= 7160 <= figure.ci95[1]
    assert abs(figure.value / 7160 - 1) < 0.01


@pytest.mark.slow
def test_a_torque_sensor_with_the_wrong_sign_is_named() -> None:
    result = analyse(sweep(sign=-1.0))
    assert figures(result)["torsional_stiffness_apparent"].value < 0
    assert any("wrong way round" in s for s in result.cannot)


@pytest.mark.parametrize("torque", [None, 1.4])
def test_only_a_run_that_could_be_about_stiffness_says_that_it_shows_none(torque: float | None) -> None:
    t = np.arange(0.0, 6.0, 1e-3)
    theta = 2.0 * np.pi * 5.0 * t
    columns = {"t": t, "theta_m": theta, "theta_l": theta / 50.0}
    if torque is not None:
        columns["tau_l"] = np.full(t.size, torque)
    gear = {"gear": {"ratio": 50}, "conditions": {"speed_rpm": 300.0}}
    said = {
        procedure: [s for s in analyse(MadeRun(columns, {"procedure": procedure, **gear})).cannot if "tiffness:" in s]
        for procedure in ("constant_torque", "kinematic_error", "other")
    }
    assert said["constant_torque"] == said["kinematic_error"] == []
    assert len(said["other"]) == 1
    assert "a lock test shows it (hdrig run stiffness-lock)" in said["other"][0]


def test_of_turns_at_two_speeds_and_none_between_all_are_taken() -> None:
    speed = np.repeat([1.0, 10.0], 5)  # turns per s: the middle is none of them
    theta = TURN * np.arange(0.0, 10.05, 0.01)
    t = np.interp(theta, TURN * np.arange(12), np.concatenate([[0.0], np.cumsum(1 / np.append(speed, 10.0))]))
    motion = SimpleNamespace(theta_m=theta, t=t)
    assert steady_part(cast("Motion", motion), slice(0, theta.size)) == slice(0, theta.size)
