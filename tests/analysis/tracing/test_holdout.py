"""Which runs are held out: whole conditions between others and repeats, none before or after all that are fitted."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from rig.analysis.tracing.runs.holdout import split


def run(speed: float, start: float) -> Any:
    """A run of 10 s at `speed` rad/s."""
    t = np.arange(2500) * 0.004
    piece = SimpleNamespace(theta_m=speed * t, omega_m=np.full(t.size, speed), tau_ext=np.zeros(t.size), t=t, dt=0.004)
    said = f"kinematic_error [('speed', {speed})]"
    return SimpleNamespace(
        name=f"{speed}_{start}", procedure="kinematic_error", said=said, has=frozenset(), pieces=(piece,), start=start
    )


def held(runs: list[Any]) -> set[tuple[float, float]]:
    return {(runs[i].pieces[0].omega_m[0], runs[i].start) for i in split(runs, ()).held_out}


def test_the_first_and_the_last_run_are_fitted_whatever_else_is_held_out() -> None:
    speeds = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0)
    in_order = [run(v, 100.0 * i + 50.0 * j) for i, v in enumerate(speeds) for j in (0, 1)]
    assert (15.0, 200.0) in held(in_order)
    assert (15.0, 250.0) in held(in_order)
    for first in speeds:
        for last in speeds:
            times = {v: 100.0 * i for i, v in enumerate([first, *(v for v in speeds if v not in (first, last)), last])}
            runs = [run(v, times[v] + 50.0 * j) for v in speeds for j in (0, 1)]
            found = held(runs)
            assert found
            assert (first, min(times.values())) not in found
            assert (last, max(times.values()) + 50.0) not in found
