"""A friction test: one encoder and the motor's torque at many speeds, gone through twice, nothing on the output."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.trace import trace
from rig.core.units import RPM
from rig.model.effect import Array

SPEEDS = (0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, -1.0, -4.0, -16.0, -64.0)  # rad/s of the motor
SECONDS, RATE, NOISE = 20.0, 200.0, 0.003
Law = Callable[[Array, Array, Array], Array]
"""Friction, N·m, of speed, motor angle and the time of the campaign."""


def usual(omega: Array, theta: Array, t: Array) -> Array:
    return np.asarray(0.15 * np.sign(omega) + 0.002 * omega)


def falling(omega: Array, theta: Array, t: Array) -> Array:
    return usual(omega, theta, t) + 0.05 * np.sign(omega) * np.exp(-np.abs(omega) / 3.0)


def thinning(omega: Array, theta: Array, t: Array) -> Array:
    return np.asarray(0.15 * np.sign(omega) + 0.01 * np.sign(omega) * np.abs(omega) ** (2 / 3))


def warming(omega: Array, theta: Array, t: Array) -> Array:
    return np.asarray(usual(omega, theta, t) * (1 - 0.25 * (1 - np.exp(-t / 400.0))))


def waving(omega: Array, theta: Array, t: Array) -> Array:
    return falling(omega, theta, t) * (1 + 0.1 * np.cos(2 * theta + 0.4))


def measured(to: Path, law: Law) -> Trace:
    """The campaign, traced."""
    rng, rows = np.random.default_rng(11), np.arange(int(SECONDS * RATE)) / RATE
    for i, speed in enumerate(SPEEDS * 2):
        run = to / f"speed{speed:g}-{i // len(SPEEDS)}"
        run.mkdir(parents=True)
        omega = speed * (1 + 0.01 * np.sin(2 * np.pi * 0.7 * rows))
        theta = np.cumsum(omega) / RATE + rng.uniform(0, 6)
        began = i * (SECONDS + 3)
        torque = law(omega, theta, began + rows) + NOISE * rng.standard_normal(rows.size)
        pq.write_table(pa.table({"t": rows, "theta_m": theta, "tau_m": torque}), run / "samples.parquet")
        manifest = {"schema": "hdrig.run/1", "procedure": "constant_speed", "gear": {"ratio": 100},
                    "started_utc": f"2024-05-07T08:{int(began) // 60:02d}:{int(began) % 60:02d}Z",
                    "conditions": {"speed_rpm": speed / RPM}}  # fmt: skip
        (run / "manifest.json").write_text(json.dumps(manifest))
    return trace(to)


def numbers(found: Trace) -> dict[str, float]:
    """Of all effects, by name."""
    return {p.name: p.value for effect in found.effects for p in effect.parameters}


@pytest.mark.slow
@pytest.mark.long
def test_friction_that_falls_with_speed_is_named_with_its_numbers(tmp_path: Path) -> None:
    found = measured(tmp_path, falling)
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("stribeck_friction",))
    told = numbers(found)
    assert told["tau_s_minus_tau_c"] == pytest.approx(0.05, rel=0.02)
    assert told["omega_s"] == pytest.approx(3.0, rel=0.02)


@pytest.mark.slow
@pytest.mark.long
def test_a_grease_that_thins_is_told_by_the_speed_and_not_named(tmp_path: Path) -> None:
    found = measured(tmp_path, thinning)
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert found.verdict.coordinate == "speed"
    assert max(found.ratios_after.values()) < 1.1


@pytest.mark.slow
@pytest.mark.long
def test_a_drive_that_warms_while_all_speeds_are_gone_through_is_named(tmp_path: Path) -> None:
    found = measured(tmp_path, warming)
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("thermal_friction_drift",))
    told = numbers(found)
    assert told["B_cold"] == pytest.approx(0.0005, rel=0.05)
    assert told["tau_cold"] == pytest.approx(0.0375, rel=0.05)


@pytest.mark.slow
@pytest.mark.long
def test_no_torque_constant_is_blamed_where_nothing_else_tells_the_torque(tmp_path: Path) -> None:
    found = measured(tmp_path, waving)
    assert "torque constant" not in found.verdict.sentence
    assert "stribeck_friction" in found.verdict.effects
    assert not found.law
