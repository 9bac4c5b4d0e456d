"""Seconds that stand out against the rest of a run are found, with noise and drift beside them."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter

from rig.analysis.tracing.residual import bursts, strikes
from rig.analysis.tracing.residual.bursts import burst, loudest_burst
from rig.analysis.tracing.residual.strikes import striking

RATE = 120.0  # rows per second
KEY = (0, "M")
STEP = 6.3e-4  # rad, of a motor encoder of 10 000 counts


@pytest.fixture
def eq(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Equations of runs whose clocks are given by `times`."""
    times: dict[Any, np.ndarray] = {}
    speeds: dict[Any, np.ndarray] = {}
    for module in (bursts, strikes):
        monkeypatch.setattr(module, "clock", lambda eq, key: times[key])
    monkeypatch.setattr(bursts, "at_rows", lambda eq, key, name: speeds.get(key, np.full(times[key].size, 10.0)))
    return SimpleNamespace(times=times, speeds=speeds, runs=[SimpleNamespace(ratio=50.0, step_m=STEP, step_l=0.0)] * 3)


def noise(eq: Any, rng: np.random.Generator, seconds: float, key: tuple[int, str] = KEY) -> np.ndarray:
    eq.times[key] = 300.0 + np.arange(int(seconds * RATE)) / RATE
    return 2e-3 * rng.standard_normal(eq.times[key].size)


def test_what_grabs_for_some_seconds_is_told_with_its_times(eq: Any, rng: np.random.Generator) -> None:
    e = noise(eq, rng, 100.0)
    e[int(38 * RATE) : int(60 * RATE)] += 0.02
    found = burst(eq, KEY, e)
    assert found is not None
    assert (found.since, found.until) == (pytest.approx(38.0, abs=0.5), pytest.approx(60.0, abs=0.5))
    assert found.over == pytest.approx(np.sqrt(1 + 0.22 * 100), rel=0.1)


def test_noise_that_swells_a_little_and_drifts_is_no_burst(eq: Any, rng: np.random.Generator) -> None:
    e = noise(eq, rng, 100.0)
    t = eq.times[KEY] - 300.0
    assert burst(eq, KEY, e * (1 + 0.3 * np.sin(t / 9)) + 1e-5 * t) is None


@pytest.mark.parametrize(("stays", "told"), [(False, False), (True, True)])
def test_a_log_is_louder_where_it_is_fast(eq: Any, rng: np.random.Generator, stays: bool, told: bool) -> None:
    """Of a log that creeps and jogs the jogs leave six times as much; at one speed that is a burst."""
    e = noise(eq, rng, 100.0)
    jogs = (eq.times[KEY] - 300.0) % 10.0 < 2.0
    e[jogs] *= 6.0
    eq.speeds[KEY] = np.where(jogs & (not stays), -170.0, 16.0) + rng.standard_normal(e.size)
    assert (burst(eq, KEY, e) is not None) is told


def test_one_loud_half_second_of_a_long_run_is_too_little(eq: Any, rng: np.random.Generator) -> None:
    e = noise(eq, rng, 100.0)
    e[1200:1260] *= 3.5
    assert burst(eq, KEY, e) is None


def test_of_a_short_run_nothing_is_known(eq: Any, rng: np.random.Generator) -> None:
    e = noise(eq, rng, 5.0)
    e[120:240] *= 20.0
    assert burst(eq, KEY, e) is None


@pytest.mark.parametrize(("counts", "told"), [(0.4, False), (1.5, True)])
def test_a_coarse_encoder_that_rests_between_two_counts_is_no_burst(
    eq: Any, rng: np.random.Generator, counts: float, told: bool
) -> None:
    key = (0, "A")
    e = 1e-3 * noise(eq, rng, 30.0, key) / 2  # 1 µrad
    e[int(9 * RATE) : int(12 * RATE)] += counts * STEP / 50
    assert (burst(eq, key, e) is not None) is told


def test_reversals_are_left_out_and_the_loudest_is_told(eq: Any, rng: np.random.Generator) -> None:
    keys = [(0, "M"), (1, "A"), (2, "R")]
    e = {key: noise(eq, rng, 30.0, key) for key in keys}
    for key, size in zip(keys, (0.01, 0.03, 0.9), strict=True):
        e[key][600:1200] += size
    found = loudest_burst(eq, e)
    assert found is not None
    assert found.key == (1, "A")


def test_friction_that_wanders_within_a_second_is_no_burst(eq: Any) -> None:
    """Of 20 half seconds one has 4.5 times the usual level by chance, where each is little more than one reading."""
    e, slow = dict[tuple[int, str], np.ndarray](), np.exp(-1 / (0.6 * RATE))
    eq.runs = eq.runs[:1] * 5
    for run, seed in enumerate((21, 1, 2, 3, 4)):
        e[run, "M"] = noise(eq, np.random.default_rng(0), 10.0, (run, "M"))
        rough = np.random.default_rng(seed).standard_normal(e[run, "M"].size + 2000)
        wander = lfilter([np.sqrt(1 - slow**2)], [1, -slow], rough)[2000:]
        e[run, "M"] = 0.2 * e[run, "M"] + 3e-3 * wander
    assert burst(eq, KEY, e[KEY]) is not None
    assert loudest_burst(eq, e) is None
    e[KEY][300:420] += 0.02
    assert loudest_burst(eq, e) is not None


def struck(eq: Any, rng: np.random.Generator, jitter: float) -> dict[tuple[int, str], np.ndarray]:
    """Three runs with a dip of a quarter of a second every 5.66 s or so, each with a phase of its own."""
    eq.timed = True
    e = {}
    for run, seconds in enumerate((65.0, 65.0, 40.0)):
        e[run, "M"] = noise(eq, rng, seconds, (run, "M"))
        t = eq.times[run, "M"] - 300.0
        for k in range(int(seconds / 5.66)):
            since = t - (1.0 + 0.7 * run + 5.66 * k + jitter * rng.uniform(-1, 1))
            e[run, "M"] -= 0.043 * np.where((since > 0) & (since < 0.25), np.sin(4 * np.pi * since) ** 2, 0.0)
    return e


def test_what_strikes_in_every_run_stands_out_and_comes_evenly(eq: Any, rng: np.random.Generator) -> None:
    e = struck(eq, rng, 0.0)
    assert loudest_burst(eq, e) is not None
    assert striking(eq, e, "M") == pytest.approx(1 / 5.66, rel=0.01)
    assert striking(eq, e, "L") is None


def test_what_strikes_at_odd_moments_does_not(eq: Any, rng: np.random.Generator) -> None:
    e = struck(eq, rng, 2.5)
    assert loudest_burst(eq, e) is not None
    assert striking(eq, e, "M") is None


def test_without_a_clock_nothing_strikes(eq: Any, rng: np.random.Generator) -> None:
    e = struck(eq, rng, 0.0)
    eq.timed = False
    assert striking(eq, e, "M") is None
