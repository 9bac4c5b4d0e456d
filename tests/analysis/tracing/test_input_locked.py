"""A stiffness test whose motor is held and whose output is wound up: the spring shows in it, and nothing else."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.runs.input_locked import is_input_locked
from rig.analysis.tracing.trace import trace

RATIO, STIFFNESS = 100.0, 18_000.0  # N·m/rad
STEP_M, STEP_L = 2 * np.pi / 65_536, 2 * np.pi / 2**20  # rad, of the encoders
TESTS = [(level, angle) for level in (15.0, 40.0, 80.0) for angle in (0.0, 1.6)]  # N·m, rad

Twist = Callable[[np.ndarray, float], np.ndarray]


def write(folder: Path, started: str, torque: np.ndarray, theta_m: np.ndarray, twist: np.ndarray) -> None:
    t = np.arange(torque.size) / 100.0
    load = np.round((theta_m / RATIO + twist) / STEP_L) * STEP_L
    columns = {"t": t, "theta_m": np.round(theta_m / STEP_M) * STEP_M, "theta_l": load, "tau_l": torque}
    folder.mkdir()
    pq.write_table(pa.table(columns), folder / "samples.parquet")
    manifest = {
        "schema": "hdrig.run/1", "procedure": "stiffness_lock", "backend": "imported", "status": "completed",
        "started_utc": started, "gear": {"ratio": RATIO}, "conditions": {"output_locked": False},
        "encoders": {"motor_counts_per_rev": 65_536, "load_counts_per_rev": 2**20},
    }  # fmt: skip
    (folder / "manifest.json").write_text(json.dumps(manifest))


def campaign(root: Path, twist: Twist, rng: np.random.Generator) -> Path:
    """Two triangles of torque at each level and angle, each test done twice."""
    minute = 0
    for level, angle in TESTS:
        for again in (1, 2):
            phase = np.arange(6000) / 3000.0
            torque = level * (2 / np.pi) * np.arcsin(np.sin(2 * np.pi * phase))
            theta_m = angle - 5e-6 * torque  # what holds the motor gives way a little
            name = f"wind_{level:g}_at{angle:g}_{again}"
            read = torque + 0.05 * rng.standard_normal(torque.size) + 0.1 * rng.standard_normal()
            write(root / name, f"2026-03-03T08:{minute:02d}:00+00:00", read, theta_m, -twist(torque, angle))
            minute += 2
    return root


def plain(torque: np.ndarray, angle: float) -> np.ndarray:
    return torque / STIFFNESS


def soft(torque: np.ndarray, angle: float) -> np.ndarray:
    """Softer about zero, as bearings and a flexspline are."""
    return torque / STIFFNESS + 1.2e-4 * np.tanh(torque / 12.0)


def by_angle(torque: np.ndarray, angle: float) -> np.ndarray:
    return torque / STIFFNESS * (1.0 + 0.06 * np.cos(2.0 * angle + 0.5))


@pytest.mark.parametrize(
    ("twist", "status", "named"),
    [
        (plain, Status.NOTHING, ()),
        pytest.param(soft, Status.EXPLAINED, ("nonlinear_stiffness",), marks=pytest.mark.long),
        (by_angle, Status.EXPLAINED, ("angle_dependent_stiffness",)),
    ],
)
@pytest.mark.slow
def test_the_spring_of_a_held_motor_is_traced(
    tmp_path: Path, rng: np.random.Generator, twist: Twist, status: Status, named: tuple[str, ...]
) -> None:
    traced = trace(campaign(tmp_path, twist, rng))
    assert (traced.verdict.status, traced.verdict.effects) == (status, named)
    after = {p.name: p for p in traced.baseline_after}
    near = 1 / (1 / STIFFNESS + 1.2e-4 / 12.0) if twist is soft else STIFFNESS
    assert after["K"].value == pytest.approx(near, rel=0.03)
    assert after.get("K_under_load", after["K"]).value == pytest.approx(STIFFNESS, rel=0.02)
    assert not any(name.startswith("theta_p_order") or name == "lag" for name in after)
    assert any("the motor stood while the output was wound up" in said for said in traced.cannot)


def test_a_motor_that_turns_and_one_beside_a_load_that_rests_are_not_held() -> None:
    rest, turns, torque = np.zeros(100), np.linspace(0.0, 6.0, 100), np.linspace(-20.0, 20.0, 100)
    wound = torque / STIFFNESS
    assert is_input_locked({"theta_m": rest, "theta_l": wound, "tau_l": torque}, RATIO)
    assert not is_input_locked({"theta_m": turns, "theta_l": turns / RATIO, "tau_l": torque}, RATIO)
    assert not is_input_locked({"theta_m": rest, "theta_l": turns / RATIO * 10.0, "tau_l": torque}, RATIO)  # it is dead
    assert not is_input_locked({"theta_m": RATIO * wound, "theta_l": rest, "tau_l": torque}, RATIO)
    assert not is_input_locked({"theta_m": rest, "theta_l": 1e-6 * torque / 20.0, "tau_l": torque}, RATIO)
    assert not is_input_locked({"theta_m": rest, "theta_l": wound, "tau_l": None}, RATIO)
