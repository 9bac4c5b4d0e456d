"""A motor that moves a whole number of counts from row to row is told; any other is not."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.motion.source import motion_of
from rig.analysis.sensors.in_step import in_step
from tests.analysis.synthetic import TURN, MadeRun


@pytest.mark.parametrize(
    ("rpm", "encoders", "side"),
    [
        (60.0, {"motor_counts_per_rev": 10_000}, "motor"),
        (60.0, {"motor_counts_per_rev": 9_731, "load_counts_per_rev": 900_000}, "load"),
        (59.58, {"motor_counts_per_rev": 10_000, "load_counts_per_rev": 900_000}, ""),
        (9.6, {"motor_counts_per_rev": 10_000, "load_counts_per_rev": 900_000}, ""),
        (1.0, {"motor_counts_per_rev": 1_000}, ""),  # less than half a count a row: every count is seen
        (60.0, {}, ""),
    ],
)
def test_whole_counts_a_row_are_told(rpm: float, encoders: dict[str, int], side: str) -> None:
    t = np.arange(3000) * 1e-3
    theta = rpm / 60.0 * TURN * t
    run = MadeRun({"t": t, "theta_m": theta, "theta_l": theta / 50.0}, {"gear": {"ratio": 50.0}, "encoders": encoders})
    motion = motion_of(run)
    assert motion is not None
    said = in_step(run, motion, rpm)
    assert (f"the {side} encoder advances" in said) if side else said == ""


def test_without_time_nothing_is_said() -> None:
    run = MadeRun(
        {"theta_m": np.arange(100.0)}, {"gear": {"ratio": 50.0}, "encoders": {"motor_counts_per_rev": 10_000}}
    )
    motion = motion_of(run)
    assert motion is not None
    assert in_step(run, motion, 60.0) == ""
