"""Floors of runs that were never repeated, and how far a single run may exceed its floor by chance."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.fit.equations import Noise
from rig.analysis.tracing.floor.noise import Measured, floor_of, leniency
from rig.analysis.tracing.thresholds import LENIENT

SPEEDS = (12.0, 12.0, 20.0, 20.0, 30.0, 30.0, 40.0, 1.0)  # rad/s; the last two were never repeated
JITTER = 5e-5  # N·m per rad/s


def campaign() -> Any:
    runs = [SimpleNamespace(procedure="speed", said=f"speed {w}", turning=w, locked=False, has=()) for w in SPEEDS]
    return SimpleNamespace(runs=runs, rows={})


def measured(freedom: float, jitter: float = JITTER) -> Measured:
    by_run = {(i, "M"): float(np.hypot(1e-3, jitter * w)) for i, w in enumerate(SPEEDS[:6])}
    noise = Noise({"M": 5e-4}, {"M": 1.0}, {"M": 1e-3})
    return Measured(noise, by_run, {}, {}, dict.fromkeys(by_run, freedom))


def floor(of: Measured, run: int) -> float:
    eq = campaign()
    eq.rows = {(run, "M"): SimpleNamespace(y=np.zeros(9), keep=np.ones(9, bool))}
    eq.runs[run].counts_m = 0.0
    return floor_of(of, eq, (run, "M"))


def test_a_clock_that_jitters_is_carried_to_speeds_that_were_never_repeated() -> None:
    assert floor(measured(500.0), 6) == pytest.approx(np.hypot(1e-3, 40 * JITTER), rel=1e-3)
    assert floor(measured(500.0), 7) == pytest.approx(1e-3, rel=1e-2)


def test_noise_that_does_not_grow_stays_as_it_is() -> None:
    assert floor(measured(500.0, jitter=0.0), 6) == pytest.approx(1e-3, rel=1e-6)


def test_a_single_run_may_exceed_a_floor_of_few_independent_parts_by_more() -> None:
    eq, at = campaign(), (6, "M")
    assert leniency(measured(500.0), eq, at) == 1.0
    assert 1.0 < leniency(measured(12.0), eq, at) <= LENIENT
    assert leniency(measured(2.0), eq, at) == LENIENT
    assert leniency(measured(2.0), eq, (6, "A")) == 1.0  # nothing is known of that channel
