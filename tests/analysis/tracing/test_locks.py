"""Lock tests whose stiffness is not the same twice: what it follows, and none where they differ no more than others."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rig.analysis.tracing.residual import locks
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.locks import lock_tests_differ

T = np.arange(0.0, 60.0, 0.04)
STARTS = (1500.0, 1570.0, 1640.0, 1710.0)
ROWS = len(STARTS) * T.size


def made(stiffness: str, thermometer: bool, rng: np.random.Generator) -> Rest:
    """Four lock tests of 60 s, noise of the floor, and a spring that changes with what `stiffness` names."""
    time = np.concatenate([start + T for start in STARTS])
    torque = np.tile(60.0 * np.sin(2 * np.pi * T / 60.0), len(STARTS))
    warm = 25.0 + 6.0 * np.sin(2 * np.pi * time / 240.0)
    changes = {
        "temperature": 0.02 * (warm - 25.0),
        "clock": 0.1 * np.cos(2 * np.pi * 0.1227 * time),
        "run": np.repeat([0.1, -0.05, -0.1, 0.05], T.size),
    }
    none = np.full(ROWS, np.nan)
    at = {"load": torque, "time": time, "temperature": warm if thermometer else none}
    e = changes[stiffness] * torque + rng.standard_normal(ROWS)
    return Rest(e, np.repeat(np.arange(4), T.size), at, 0.04, np.zeros((ROWS, 0)), np.zeros((0, 0)))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("stiffness", "thermometer", "coordinate"),
    [
        ("temperature", True, "temperature"),
        ("temperature", False, "time"),
        ("clock", True, "time_periodic"),
        ("run", True, "time"),
    ],
)
def test_what_the_stiffness_follows_is_said(
    rng: np.random.Generator, stiffness: str, thermometer: bool, coordinate: str
) -> None:
    found = locks._followed(made(stiffness, thermometer, rng))
    assert found.coordinate == coordinate
    assert found.share > 0.6
    if stiffness == "clock":
        assert found.frequency_hz == pytest.approx(0.1227, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("times", "said"), [(1.4, False), (4.0, True)])
def test_lock_tests_that_differ_like_all_others_are_no_finding(
    monkeypatch: pytest.MonkeyPatch, rng: np.random.Generator, times: float, said: bool
) -> None:
    runs = [SimpleNamespace(locked=i > 3) for i in range(6)]
    by_run = {(i, "A"): 4e-6 * (times if runs[i].locked else 1.0) for i in range(6)}
    measured: Any = SimpleNamespace(by_run=by_run)
    eq: Any = SimpleNamespace(runs=runs)
    monkeypatch.setattr(locks, "rest", lambda *a, **k: made("run", False, rng))
    found = lock_tests_differ(eq, measured, {(i, "A"): np.zeros(3) for i in range(6)})
    assert (found is not None) is said
    if found is not None:
        assert found[1] == pytest.approx(times)
