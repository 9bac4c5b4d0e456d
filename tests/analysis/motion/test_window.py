"""The measured part of a run at constant torque: found from the command where it was recorded, else from the speed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from rig.analysis.motion.source import Motion, motion_of
from rig.analysis.motion.window import measured_window, part
from tests.analysis.synthetic import TURN, Array, MadeRun

DT = 0.001


def made(speed: Array, columns: dict[str, Array] | None = None, **conditions: Any) -> tuple[MadeRun, Motion]:
    """A run of that speed [rad/s] at 1 kHz."""
    theta = np.cumsum(speed) * DT
    table = {"t": np.arange(theta.size) * DT, "theta_m": theta, "theta_l": theta / 50.0, **(columns or {})}
    run = MadeRun(table, {"procedure": "constant_torque", "gear": {"ratio": 50.0}, "conditions": conditions})
    motion = motion_of(run)
    assert motion is not None
    return run, motion


def phases() -> tuple[Array, Array, Array]:
    """Speed, asked torque and reference of a run: 3 s under the loop, 8 s of one torque, 2 s under the loop."""
    rng = np.random.default_rng(1)
    speed = np.concatenate((np.linspace(0, 30, 3000), np.full(8000, 30.0), np.linspace(30, 0, 2000)))
    asked = 0.4 + 0.05 * rng.standard_normal(speed.size)
    asked[3000:11000] = 0.41
    reference = np.where(asked == 0.41, np.nan, np.cumsum(speed) * DT)
    return speed, asked, reference


def test_the_rows_of_one_torque_without_a_reference_are_the_window_less_the_time_to_settle() -> None:
    speed, asked, reference = phases()
    run, motion = made(speed, {"tau_ask": asked, "theta_ref": reference}, settle_s=2.5)
    window = measured_window(run, motion)
    assert (window.lo, window.hi) == (5500, 11000)
    assert window.torque == pytest.approx(0.41)
    assert window.spread == 0.0
    assert "2.5 s for the speed to settle" in window.how


def test_a_constant_torque_that_follows_a_reference_is_not_the_window() -> None:
    speed, asked, reference = phases()
    asked[:3000], reference[:3000] = 0.39, np.cumsum(speed[:3000]) * DT  # the loop happened to ask for one torque
    run, motion = made(speed, {"tau_ask": asked, "theta_ref": reference}, settle_s=0.0)
    assert measured_window(run, motion).lo == 3000


def test_a_run_of_another_logger_that_had_settled_is_taken_whole() -> None:
    rng = np.random.default_rng(2)
    run, motion = made(30.0 + 0.1 * rng.standard_normal(8000))
    window = measured_window(run, motion)
    assert (window.lo, window.hi) == (0, 8000)
    assert np.isnan(window.torque)


def test_a_run_up_of_another_logger_is_cut_off_by_its_speed() -> None:
    t = np.arange(12000) * DT
    run, motion = made(30.0 * (1 - np.exp(-t / 0.4)) + 0.05 * np.sin(9 * t))
    window = measured_window(run, motion)
    assert 1.0 < window.lo * DT < 3.5
    assert window.hi == 12000
    assert "had not settled" in window.how


def test_a_torque_that_never_stays_the_same_leaves_the_whole_run_and_says_so() -> None:
    speed, asked, _ = phases()
    run, motion = made(speed, {"tau_ask": asked + 1e-3 * np.arange(asked.size) % 0.01})
    assert "never the same" in measured_window(run, motion).how


def test_a_part_of_a_motion_keeps_the_rows_of_other_columns() -> None:
    run, motion = made(np.full(4000, TURN))
    assert run.columns["t"][100] == part(motion, 100, 200).pick(run.columns["t"])[0]  # type: ignore[index]
    nested = part(part(motion, 1000, 3000), 10, 20)
    assert nested.pick(run.columns["t"])[0] == run.columns["t"][1010]  # type: ignore[index]
