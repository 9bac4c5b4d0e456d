"""The joint of an arm: two encoders and the motor's torque, no torque sensor, and nobody says what the load weighs or
how heavy it is to turn. The weight tells the spring, the wind-up of the inertia tells the inertia."""

import json
from math import sin, tanh
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.outcome.result import Trace
from rig.analysis.tracing.trace import trace
from rig.core.units import ARCSEC
from rig.model.effect import Array

RATIO, RATE, LASTS, STEPS = 100, 500.0, 30.0, 5  # Hz of the file, s, steps of the simulation a row
K, B_SP, J_L, WEIGHT, TILT, J_M = 12_000.0, 12.0, 1.2, 25.0, 0.2, 1.5e-4
RUBS, DRAGS = 0.6, 0.5  # friction of the load, N·m and N·m·s/rad


def excitation(rng: np.random.Generator, t: Array) -> Array:
    """Five harmonics of the output's angle, rad, as a joint is identified by."""
    k = np.arange(1, 6)[:, None]
    a, b = rng.normal(size=(2, 5, 1)) * 0.6 / k**1.5
    waves = 2 * np.pi * 2 * k / LASTS * t
    return np.asarray((a * np.sin(waves) + b * np.cos(waves)).sum(0))


def driven(motor: Array, shrinks: bool, h: float) -> tuple[Array, Array, Array]:
    """Load angle, torque through the gear, and θ̃_p′ of a motor that is led, one small step after the other."""
    speed = np.gradient(motor, h)
    error = ARCSEC * (30 * np.cos(2 * motor + 0.3) + 8 * np.cos(4 * motor) + 5 * np.cos(motor))
    slope = -ARCSEC * (60 * np.sin(2 * motor + 0.3) + 32 * np.sin(4 * motor) + 5 * np.sin(motor))
    x, v, torque = motor[0] / RATIO - error[0] - WEIGHT * sin(motor[0] / RATIO + TILT) / K, speed[0] / RATIO, 0.0
    angles, torques, levers = (np.empty(motor.size) for _ in range(3))
    rows = zip(motor.tolist(), speed.tolist(), error.tolist(), slope.tolist(), strict=True)
    for i, (theta, omega, e, de) in enumerate(rows):
        left = 0.5 + 0.5 * 2.718281828 ** (-abs(torque) / 5) if shrinks else 1.0
        torque = K * (theta / RATIO - left * e - x) + B_SP * (omega / RATIO - left * de * omega - v)
        angles[i], torques[i], levers[i] = x, torque, left * de
        v += h * (torque - WEIGHT * sin(x + TILT) - RUBS * tanh(v / 0.002) - DRAGS * v) / J_L
        x += h * v
    return angles, torques, levers


def joint(
    to: Path,
    shrinks: bool = False,
    stribeck: float = 0.0,
    trajectories: int = 4,
    swing: float | None = None,
    mesh: float = 0.0,
    sensor: bool = False,
    runout: float = 0.0,
) -> Trace:
    """Trajectories run twice each, traced. `swing`: rad of the output either way; `mesh`: friction over the torque;
    `runout`: rad once a turn of the load encoder."""
    rng = np.random.default_rng(23)
    h = 1 / RATE / STEPS
    t = h * np.arange(int(LASTS / h))
    for number in range(trajectories):
        moved = excitation(rng, t)
        if swing is not None:
            moved *= swing / np.abs(moved - moved.mean()).max()
        motor = RATIO * moved + 1.3
        angle, torque, slope = driven(motor, shrinks, h)
        speed, acceleration = np.gradient(motor, h), np.gradient(np.gradient(motor, h), h)
        dry = 0.12 + stribeck * np.exp(-np.abs(speed) / 8) + mesh * np.abs(torque) / RATIO
        rubs = np.tanh(speed / 0.2) * dry + 8e-4 * speed
        drive = torque * (1 / RATIO - slope) + J_M * acceleration + rubs
        for again in range(2):
            row = slice(None, None, STEPS)
            noise = rng.standard_normal((3, t[row].size))
            read = angle[row] + runout * np.cos(angle[row])
            columns = {"t": t[row], "theta_m": motor[row], "theta_l": read + 0.7 * ARCSEC * noise[0],
                       "tau_m": drive[row] + 0.01 * noise[1]}  # fmt: skip
            if sensor:
                columns["tau_l"] = torque[row] + 0.3 + 0.03 * noise[2]
            run = to / f"trajectory-{number}-{again}"
            run.mkdir(parents=True)
            pq.write_table(pa.table(columns), run / "samples.parquet")
            manifest = {"schema": "hdrig.run/1", "procedure": "other", "gear": {"ratio": RATIO},
                        "started_utc": f"2024-05-07T08:{2 * number + again:02d}:00Z"}  # fmt: skip
            (run / "manifest.json").write_text(json.dumps(manifest))
    return trace(to)


def size(found: Trace, name: str) -> float:
    return next(p.value for effect in found.effects for p in effect.parameters if p.name == name)


@pytest.mark.slow
@pytest.mark.long
def test_an_arms_weight_is_named_and_tells_spring_and_inertia(tmp_path: Path) -> None:
    found = joint(tmp_path)
    assert (found.verdict.status, found.verdict.effects) == (Status.EXPLAINED, ("gravity_unbalance",))
    known = {p.name: p for p in found.baseline_after}
    assert known["K"].value == pytest.approx(K, rel=0.02)
    assert known["J_m"].value == pytest.approx(J_M, rel=0.05)
    assert known["theta_p_order_2"].value == pytest.approx(30.0, rel=0.02)  # arcsec
    assert size(found, "unbalance_amplitude") == pytest.approx(WEIGHT, rel=0.01)


@pytest.mark.slow
@pytest.mark.long
def test_what_leans_on_the_torque_is_told_under_a_weight_nobody_declared(tmp_path: Path) -> None:
    found = joint(tmp_path, shrinks=True, stribeck=0.06)
    assert found.verdict.status is Status.EXPLAINED
    assert set(found.verdict.effects) == {"gravity_unbalance", "load_dependent_kinematic_error", "stribeck_friction"}
    assert size(found, "A_inf") == pytest.approx(0.5, abs=0.02)


SWING = 0.44  # rad: 25 degrees either way, a seventh of a turn in all


@pytest.mark.slow
@pytest.mark.long
def test_a_joint_that_swings_by_25_degrees_tells_its_weight_spring_and_friction(tmp_path: Path) -> None:
    found = joint(tmp_path, stribeck=0.06, swing=SWING)
    assert found.verdict.status is Status.EXPLAINED
    assert set(found.verdict.effects) == {"gravity_unbalance", "stribeck_friction"}
    assert size(found, "unbalance_amplitude") == pytest.approx(WEIGHT, rel=0.01)
    known = {p.name: p for p in found.baseline_after}
    assert known["K"].value == pytest.approx(K, rel=0.02)
    assert known["J_m"].value == pytest.approx(J_M, rel=0.05)


@pytest.mark.slow
@pytest.mark.long
def test_friction_of_the_mesh_is_searched_for_by_a_torque_that_has_the_weight(tmp_path: Path) -> None:
    found = joint(tmp_path, mesh=0.3, swing=SWING)
    assert set(found.verdict.effects) == {"gravity_unbalance", "load_dependent_friction"}
    assert size(found, "mu_L") == pytest.approx(0.3, rel=0.05)
    assert size(found, "unbalance_amplitude") == pytest.approx(WEIGHT, rel=0.03)


@pytest.mark.slow
@pytest.mark.long
def test_a_weight_read_by_a_torque_sensor_hides_no_friction_of_the_motor(tmp_path: Path) -> None:
    """Its evidence is ten thousand times as much, in a channel where friction does not show."""
    found = joint(tmp_path, stribeck=0.06, swing=SWING, sensor=True)
    assert set(found.verdict.effects) == {"gravity_unbalance", "stribeck_friction"}


@pytest.mark.slow
@pytest.mark.long
def test_a_runout_beside_a_weight_on_a_joint_that_swings_is_no_spring(tmp_path: Path) -> None:
    found = joint(tmp_path, swing=SWING, sensor=True, runout=20 * ARCSEC)
    assert set(found.verdict.effects) == {"gravity_unbalance", "output_once_per_rev"}
    assert size(found, "order_1_amplitude") == pytest.approx(20 * ARCSEC, rel=0.1)
