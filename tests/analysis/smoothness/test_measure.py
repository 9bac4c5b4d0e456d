"""Smoothness: sticking and hunting are seen, named with their number, and met with the right gain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis import Verdict, analyse
from rig.analysis.motion.source import Motion
from rig.analysis.motion.speed import motor_speed
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.smoothness.measure import smoothness
from rig.core.units import RPM, TURN
from rig.report.record import as_json
from tests.analysis.synthetic import MadeRun, count, slow_run, triangle

OMEGA = 4 * 4 * TURN * 0.01  # rad/s: 9.6 rpm


def run_of(theta_m: np.ndarray, t: np.ndarray, reference: np.ndarray | None = None) -> MadeRun:
    columns = {"t": t, "theta_m": count(theta_m, 10_000), "theta_l": count(theta_m / 50, 900_000)}
    if reference is not None:
        columns["theta_ref"] = reference
    return MadeRun(columns, {"procedure": "kinematic_error", "gear": {"ratio": 50}})


def stick_slip(t: np.ndarray, period: float, stuck: float) -> np.ndarray:
    """A motor that waits for `stuck` of every `period` [s] and then catches up with its reference."""
    phase = (t / period) % 1.0
    catching = np.clip((phase - stuck) / (1 - stuck), 0.0, 1.0)
    return triangle(np.maximum((np.floor(t / period) + catching) * period, 0), 4 * TURN, 0.01)


@pytest.mark.parametrize("stuck", [0.1, 0.5, 0.76])
def test_sticking_is_measured_and_rejects_the_run_with_the_gain_to_raise(stuck: float) -> None:
    t = np.arange(0, 100, 1e-3)
    result = analyse(run_of(stick_slip(t, 0.8, stuck), t, triangle(t, 4 * TURN, 0.01)))
    share = next(e for e in result.estimates if e.name == "stuck_share").value
    assert abs(share - 100 * stuck) < 6
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "Kd" in result.sentence
    assert "hdrig tune" in result.sentence
    assert "kinematic_error_peak_to_peak" in {e.name for e in result.estimates}, "figures are shown all the same"
    counts = {e.name: e.counts for e in result.estimates}
    assert result.rejected
    assert (counts["stuck_share"], counts["kinematic_error_peak_to_peak"]) == (True, False)
    said = as_json(result)
    assert (said["rejected"], said["estimates"]["kinematic_error_peak_to_peak"]["counts"]) == (True, False)


def test_hunting_is_found_with_its_frequency_and_answered_with_less_integral_gain() -> None:
    t = np.arange(0, 100, 1e-3)
    theta = triangle(t, 4 * TURN, 0.01) + 0.3 * OMEGA / (2 * np.pi * 1.7) * np.sin(2 * np.pi * 1.7 * t)
    result = analyse(run_of(theta, t))
    assert result.verdict is Verdict.INCONCLUSIVE
    assert "1.70 Hz" in result.sentence
    assert "Ki" in result.sentence
    hunting = next(e for e in result.estimates if e.name == "hunting_frequency")
    assert abs(hunting.value - 1.7) < 0.02


def test_ripple_that_follows_the_angle_is_not_hunting() -> None:
    t = np.arange(0, 100, 1e-3)
    base = triangle(t, 4 * TURN, 0.01)
    result = analyse(run_of(base + 0.3 / 2 * np.sin(2 * base), t))
    assert "hunting_frequency" not in {e.name for e in result.estimates}
    assert abs(next(e for e in result.estimates if e.name == "speed_scatter").value - 100 * 0.3 / np.sqrt(2)) < 3


def test_a_smooth_run_passes_and_its_reversals_do_not_count() -> None:
    result = analyse(slow_run(0))
    assert all(c.passed for c in result.checks)
    assert next(e for e in result.estimates if e.name == "stuck_share").value == 0.0
    assert next(e for e in result.estimates if e.name == "speed_scatter").value < 2.0


def test_a_motor_that_stood_half_the_time_is_held_to_the_reference_not_to_itself() -> None:
    t = np.arange(0, 100, 1e-3)
    theta, reference = stick_slip(t, 0.8, 0.5), triangle(t, 4 * TURN, 0.01)
    motion = Motion(50.0, theta, theta / 50, t, None)
    found = smoothness(motion, find_strokes(motion), reference)
    assert found is not None
    assert abs(found.nominal_rpm - 9.6) < 0.01


def test_the_speed_of_counts_is_right_to_a_third_of_a_percent_at_one_and_a_half_counts_a_row() -> None:
    t = np.arange(0, 20, 1e-3)
    speed = motor_speed(t, count(OMEGA * t, 10_000))
    assert abs(speed.omega.mean() / RPM - 9.6) < 1e-3
    assert speed.omega.std() / OMEGA < 0.0035


def test_the_speed_is_right_when_rows_come_unevenly() -> None:
    rng = np.random.default_rng(0)
    t = np.cumsum(rng.uniform(0.2e-3, 1.8e-3, 20_000))
    speed = motor_speed(t, count(OMEGA * t, 10_000))
    assert speed.omega.std() / OMEGA < 0.005


def test_without_a_nominal_speed_a_standing_motor_says_nothing() -> None:
    t = np.arange(0, 10, 1e-3)
    motion = Motion(50.0, np.zeros_like(t), np.zeros_like(t), t, None)
    assert smoothness(motion, find_strokes(motion)) is None
    assert analyse(replace(run_of(np.zeros_like(t), t))).estimates == ()
