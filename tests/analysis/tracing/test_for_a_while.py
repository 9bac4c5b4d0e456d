"""Friction that is more for a while is told from friction that scatters, falls, or goes with the speed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rig.analysis.tracing.answer import Status
from rig.analysis.tracing.residual.for_a_while import ForAWhile, level_for_a_while
from rig.analysis.tracing.residual.levels import Runs
from tests.analysis.tracing.spiked import Columns, spiked, started

K = 30
SINCE = 60.0 * np.arange(K)  # s
SPEED, WAY = np.resize([1.0, 6.0, 13.0, 13.0, 21.0, 42.0], K), np.resize([0.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0], K)
RUNS = Runs(np.zeros(K), SPEED, WAY, SINCE, np.arange(K))
WITHIN = (np.arange(K) >= 9) & (np.arange(K) < 20)


def scattered(seed: int) -> np.ndarray:
    return 0.3 * np.random.default_rng(seed).standard_normal(K)


@pytest.mark.parametrize("seed", range(5))
def test_what_runs_have_for_a_while_is_told_with_how_much(seed: int) -> None:
    left = scattered(seed) + 2.0 * WITHIN - 0.01 * SPEED + 0.4 * WAY
    shuffled = np.random.default_rng(seed).permutation(K)
    runs = Runs(left[shuffled], SPEED[shuffled], WAY[shuffled], SINCE[shuffled], np.arange(K))
    found = level_for_a_while(runs)
    assert found
    inside, size, share = found
    assert sorted(shuffled[inside]) == np.flatnonzero(WITHIN).tolist()
    assert size == pytest.approx(2.0, abs=0.4)
    assert share > 0.85


@pytest.mark.parametrize(
    "left",
    [
        0.0 * SINCE,
        3.0 * np.exp(-SINCE / 600.0),
        0.08 * SPEED * (1 + WAY),
        0.8 * WITHIN,
        3.0 * (np.arange(K) == 7),
    ],
    ids=["scatters", "falls", "goes with the speed", "less than the floor", "one run"],
)
def test_nothing_else_is_such_a_while(left: np.ndarray) -> None:
    assert level_for_a_while(replace(RUNS, left=left + scattered(1))) is None


@pytest.mark.long
def test_chance_is_none_once_in_two_hundred_campaigns_whatever_it_scatters_by() -> None:
    assert not [seed for seed in range(200) if level_for_a_while(replace(RUNS, left=10.0 * scattered(seed)))]


def test_a_few_runs_tell_nothing() -> None:
    few = Runs(*(x[5:14] for x in (2.0 * WITHIN, SPEED, WAY, SINCE, np.arange(K))))
    assert level_for_a_while(few) is None


def test_its_sentence_has_the_torque_and_both_times() -> None:
    said = ForAWhile("M", -5.6e-3, 760.0, 1290.0, 0.97).sentence()
    assert "is 0.0056 N·m less in all runs between 760 and 1290 s" in said


@pytest.mark.slow
@pytest.mark.long
def test_a_brake_that_drags_for_a_while_below_the_floor_of_the_runs_is_told(tmp_path: Path, shared: Path) -> None:
    campaign = shared / "cases" / "open-1"
    first = min(started(run) for run in campaign.iterdir() if run.is_dir())

    def drags(c: Columns, began: float) -> Columns:
        t = began - first + c["t"]
        return {"tau_m": c["tau_m"] + 5.6e-3 * np.sign(np.gradient(c["theta_m"])) * ((t > 760) & (t < 1290))}

    verdict = spiked(tmp_path, campaign, drags).verdict
    assert (verdict.status, verdict.effects, verdict.coordinate) == (Status.UNKNOWN, (), "time")
    assert "N·m more in all runs between" in verdict.sentence
