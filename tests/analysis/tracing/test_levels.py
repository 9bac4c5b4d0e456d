"""Friction of its own at one speed: told by what runs at that speed have in common, and by nothing less."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.levels import between, left_by_runs, levels
from tests.analysis.tracing.spiked import Columns, spiked

SPEEDS = np.repeat([6.3, 12.6, 21.0, 31.4, 41.9], 4)  # rad/s of the motor, four runs at each
HUMP, SCATTER = 0.018, 0.0017  # N·m, at 200 rpm; of every run's friction, 1 %


def scattered(seed: int) -> np.ndarray:
    return 0.5 * np.random.default_rng(seed).standard_normal(SPEEDS.size)


def humped(c: Columns, began: float) -> Columns:
    """Friction scatters from run to run, and has a hump at 200 rpm."""
    way = np.sign(np.gradient(c["theta_m"]))
    speed = abs(c["theta_m"][-1] - c["theta_m"][0]) / (c["t"][-1] - c["t"][0])
    hump = HUMP * np.exp(-(((speed - 20.9) / 4.0) ** 2))
    scatter = SCATTER * np.random.default_rng(int(began)).standard_normal()
    return {"tau_m": c["tau_m"] + way * (hump + scatter)}


def test_runs_at_speeds_a_tenth_apart_share_a_level() -> None:
    assert levels(np.array([21.0, 6.2, 20.4, 6.4, 1.0])).tolist() == [2, 1, 2, 1, 0]


def test_a_hump_that_four_runs_share_is_told_under_the_floor_of_each() -> None:
    share = between(scattered(1) + 2.0 * (levels(SPEEDS) == 2), levels(SPEEDS))
    assert share is not None
    assert share > 0.6


def test_chance_is_not_told_once_in_three_thousand_campaigns() -> None:
    assert not [seed for seed in range(3000) if between(scattered(seed) * 4.0, levels(SPEEDS)) is not None]


@pytest.mark.parametrize("speeds", [SPEEDS[:8], SPEEDS[::2][:7]])
def test_two_speeds_or_a_few_runs_tell_nothing(speeds: np.ndarray) -> None:
    assert between(100.0 * levels(speeds) + scattered(2)[: speeds.size], levels(speeds)) is None


def test_what_is_the_same_to_a_hundredth_of_a_floor_is_too_small_to_tell() -> None:
    assert between(0.01 * scattered(3) + 0.1 * (levels(SPEEDS) == 2), levels(SPEEDS)) is None


def test_a_runs_mean_is_put_back_and_turns_with_its_way() -> None:
    """One run backward, one forth and back, one that kept nothing of its mean, one mostly forward."""
    way = np.array([[-1.0] * 100, [1.0, -1.0] * 50, [1.0] * 100, [1.0] * 70 + [-1.0] * 30])
    offset = np.repeat([0.5, 0.5, 1.0, 0.5], 100)
    friction = 3.0 * way * np.repeat([0.5, 1.0, 0.0, 1.0], 100).reshape(4, 100)
    at = {"direction": way.ravel(), "speed": 20.0 * way.ravel(), "time": np.arange(400.0)}
    run = np.repeat(np.arange(4), 100)
    found = left_by_runs(Rest(friction.ravel(), run, at, 0.01, np.zeros((400, 0)), np.zeros((0, 0)), offset=offset))
    assert found.left.tolist() == pytest.approx([3.0, 3.0])
    assert found.speed.tolist() == pytest.approx([20.0, 20.0])


@pytest.mark.slow
@pytest.mark.long
def test_a_hump_of_friction_beside_friction_that_scatters_is_told(tmp_path: Path, shared: Path) -> None:
    verdict = spiked(tmp_path, shared / "cases" / "open-1", humped).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "speed")
