"""A transmission-error test: two encoders, one speed, no torque. What it tells is told rightly, and nothing else is."""

from __future__ import annotations

import itertools
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
from rig.core.units import ARCSEC, RPM, TURN
from rig.model.effect import Array

RATIO, RATE, NOISE = 100, 100.0, 0.7  # NOISE: arcsec of the load encoder
Law = Callable[[Array, Array], Array]
"""Kinematic error, arcsec, of the motor angle and the time."""


def bench(
    to: Path, law: Law, timed: bool = True, speeds: tuple[float, ...] = (60.0, -60.0), turns: float = 2.0
) -> Trace:
    """Two runs each way over output turns of a gear without wind-up, whose error has orders 1, 2, 4 and 6."""
    rng = np.random.default_rng(7)
    for rpm, again in itertools.product(speeds, range(2)):
        run = to / f"speed{rpm:g}-{again}"
        run.mkdir(parents=True)
        t = np.arange(int(turns * RATIO * 60 * RATE / abs(rpm))) / RATE
        motor = rpm * RPM * t + 0.002 * abs(rpm) * RPM * np.sin(TURN * 0.31 * t) + rng.uniform(0, TURN)
        own = 5 * np.cos(motor) + 30 * np.cos(2 * motor + 0.3) + 8 * np.cos(4 * motor) + 3 * np.cos(6 * motor + 1)
        error = own + law(motor, t) + NOISE * rng.standard_normal(t.size)
        columns = {"theta_m": motor, "theta_l": motor / RATIO - error * ARCSEC} | ({"t": t} if timed else {})
        pq.write_table(pa.table(columns), run / "samples.parquet")
        manifest = {"schema": "hdrig.run/1", "procedure": "constant_speed", "gear": {"ratio": RATIO},
                    "started_utc": f"2024-05-07T08:{10 * again + int(rpm > 0):02d}:00Z",
                    "conditions": {"speed_rpm": abs(rpm)}}  # fmt: skip
        (run / "manifest.json").write_text(json.dumps(manifest))
    return trace(to)


def once_a_turn(motor: Array, t: Array) -> Array:
    return 20 * np.cos(motor / RATIO + 0.2)


def on_the_flexspline(motor: Array, t: Array) -> Array:
    return 6 * np.cos(2 * (1 + 1 / RATIO) * motor + 0.7)


def orders(found: Trace) -> dict[int, float]:
    """Of the kinematic error, arcsec."""
    sizes = {p.name.removeprefix("theta_p_order_"): p.value for p in found.baseline_after if "order" in p.name}
    return {int(n): size for n, size in sizes.items()}


@pytest.mark.slow
@pytest.mark.parametrize("timed", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_rigid_gear_has_its_error_and_no_stiffness(tmp_path: Path, timed: bool) -> None:
    found = bench(tmp_path, lambda motor, t: np.zeros_like(t), timed)
    assert found.verdict.status is Status.NOTHING
    assert "K" not in {p.name for p in found.baseline}
    sizes = orders(found)
    assert [sizes[n] for n in (1, 2, 4, 6)] == pytest.approx([5.0, 30.0, 8.0, 3.0], abs=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("timed", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_runout_and_the_flexspline_are_named_and_a_weight_is_its_rival(tmp_path: Path, timed: bool) -> None:
    found = bench(tmp_path, lambda motor, t: once_a_turn(motor, t) + on_the_flexspline(motor, t), timed)
    assert found.verdict.status is Status.AMBIGUOUS
    assert found.verdict.effects == ("output_once_per_rev", "flexspline_frame_error")
    assert found.verdict.rivals == ("gravity_unbalance",)
    assert found.next_run is not None
    told = {p.name: p.value for effect in found.effects for p in effect.parameters}
    assert told["order_1_amplitude"] == pytest.approx(20 * ARCSEC, rel=0.01)
    assert told["order_2.02_amplitude"] == pytest.approx(6 * ARCSEC, rel=0.01)
    assert orders(found)[2] == pytest.approx(30.0, abs=0.05)


@pytest.mark.slow
@pytest.mark.long
def test_balls_of_the_wave_generators_bearing_are_an_order_and_no_resonance(tmp_path: Path) -> None:
    found = bench(tmp_path, lambda motor, t: 4 * np.cos(12.3737 * motor))
    assert (found.verdict.status, found.verdict.effects) == (Status.UNKNOWN, ())
    assert (found.verdict.coordinate, found.verdict.order) == ("motor_angle", pytest.approx(12.3737, abs=1e-3))


@pytest.mark.slow
@pytest.mark.long
def test_a_mount_that_warms_is_neither_a_late_reading_nor_an_order_beyond_the_rows(tmp_path: Path) -> None:
    found = bench(tmp_path, lambda motor, t: 12 * (1 - np.exp(-t / 60)), speeds=(60.0,))
    assert "channel_time_skew" not in found.verdict.effects
    assert found.verdict.order is None
