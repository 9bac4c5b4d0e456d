"""Friction that comes and goes is told from friction that scatters, wanders, or goes with the speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from rig.analysis.tracing.residual.comes_and_goes import ComesAndGoes, wave_of_runs
from rig.analysis.tracing.residual.levels import Runs

K = 31
SINCE = np.concatenate([[40.0, 110.0, 230.0], 330.0 + 70.0 * np.arange(10), 1010.0 + 32.0 * np.arange(18)])  # s
SPEED, WAY = np.resize([1.0, 6.0, 13.0, 13.0, 21.0, 42.0], K), np.resize([0.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0], K)
RUNS = Runs(np.zeros(K), SPEED, WAY, SINCE, np.arange(K))
PERIOD = 370.0  # s


def switched(on: float) -> np.ndarray:
    """One for a share `on` of the period, smoothed by a lag of a tenth of it."""
    t = np.arange(0.0, 3000.0)
    level = np.convolve(((t % PERIOD) < on * PERIOD).astype(float), np.exp(-t[:400] / 37.0) / 37.0)[: t.size]
    return np.asarray(np.interp(SINCE + 740.0, t, level))


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("on", [0.35, 0.5])
def test_what_comes_and_goes_is_told_with_its_period_and_size(seed: int, on: float) -> None:
    left = 4.0 * switched(on) + 0.4 * np.random.default_rng(seed).standard_normal(K) - 0.01 * SPEED + 0.4 * WAY
    found = wave_of_runs(replace(RUNS, left=left))
    assert found
    hz, size, share = found
    assert 1.0 / hz == pytest.approx(PERIOD, rel=0.04)
    assert size == pytest.approx(2.0, abs=0.6)
    assert share > 0.85


@pytest.mark.parametrize("memory", [0.0, 150.0, 300.0, 1e6], ids=["scatters", "wanders", "wanders slowly", "walks"])
def test_chance_comes_round_in_none_of_a_hundred_campaigns(memory: float) -> None:
    keeps = np.exp(-np.diff(SINCE) / memory) if memory else np.zeros(K - 1)
    for seed in range(100):
        kick = np.random.default_rng(seed).standard_normal(K)
        left = [kick[0]]
        for keep, x in zip(keeps, kick[1:], strict=True):
            left.append(keep * left[-1] + np.sqrt(max(1.0 - keep**2, 1e-4)) * x)
        assert wave_of_runs(replace(RUNS, left=10.0 * np.array(left))) is None


@pytest.mark.parametrize(
    "left",
    [3.0 * np.exp(-SINCE / 600.0), 0.08 * SPEED * (1 + WAY), 0.3 * switched(0.5), 2.0 * (SINCE > 1000.0)],
    ids=["falls", "goes with the speed", "less than the floor", "from one moment on"],
)
def test_nothing_else_is_such_a_wave(left: np.ndarray) -> None:
    noise = 0.05 * np.random.default_rng(1).standard_normal(K)
    assert wave_of_runs(replace(RUNS, left=left + noise)) is None


def test_a_few_runs_tell_nothing() -> None:
    assert wave_of_runs(Runs(*(x[5:18] for x in (4.0 * switched(0.5), SPEED, WAY, SINCE, np.arange(K))))) is None


def test_what_is_said_has_size_period_and_share() -> None:
    said = ComesAndGoes("M", 0.0123, 1 / 370.0, 0.9).sentence()
    assert "motor torque comes and goes by up to 0.012 N·m every 370 s" in said
    assert "90% of what runs differ by" in said
