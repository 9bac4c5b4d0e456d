"""The figures of the motor's speed hold what a made-up run was given, as often as their intervals say."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis import analyse
from rig.core.units import RPM
from tests.analysis.synthetic import MadeRun, count

SECONDS, DRIFT, WANDER = 10.0, 0.6, 0.3  # s, rpm over the run, rpm from one tenth of a second to the next


def run(seed: int) -> MadeRun:
    """120 rpm that rises by DRIFT and wanders."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, SECONDS, 1e-3)
    speed = 120.0 + DRIFT * t / SECONDS + WANDER * np.repeat(rng.standard_normal(100), 100)
    theta = np.cumsum(speed) * RPM * 1e-3
    columns = {"t": t, "theta_m": count(theta, 65_536), "theta_l": count(theta / 50, 1_296_000)}
    return MadeRun(columns, {"procedure": "constant_torque", "gear": {"ratio": 50}, "conditions": {"speed_rpm": 120.0}})


@pytest.mark.slow
def test_drift_and_ripple_lie_within_their_intervals() -> None:
    drift, ripple = [], []
    for seed in range(24):
        found = {e.name: e for e in analyse(run(seed)).estimates}
        low, high = found["speed_drift"].ci95
        drift.append(low <= DRIFT <= high)
        assert high - low < 2.0 * DRIFT, "wide enough for anything"
        ripple.append((found["speed_ripple"].value, *found["speed_ripple"].ci95))
    assert sum(drift) >= 19, "24 of 95 %"
    value, low, high = np.array(ripple).T
    usual = np.sqrt(np.mean(value**2))  # what the windows leave of it, and the drift
    assert 0.7 * WANDER < usual < 1.3 * WANDER
    assert np.sum((low <= usual) & (usual <= high)) >= 19
    assert np.all(high - low < WANDER)
