"""A loop that hunts faster than the speed windows see must not pass for smooth."""

from __future__ import annotations

import numpy as np
import pytest

from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import Stroke, find_strokes
from rig.analysis.smoothness.measure import smoothness

STEP = 2 * np.pi / 10_000  # rad, one count
OMEGA = 1.0053  # rad/s, 9.6 rpm


def motion(ripple: float, hz: float, seconds: float = 40.0) -> tuple[Motion, list[Stroke]]:
    """9.6 rpm with a speed ripple of `ripple` (1 σ, of nominal) at `hz`, counted."""
    t = np.arange(0.0, seconds, 0.001)
    swing = np.sqrt(2) * ripple * OMEGA / (2 * np.pi * hz)
    theta = np.floor((OMEGA * t + swing * np.sin(2 * np.pi * hz * t)) / STEP) * STEP
    found = Motion(ratio=50.0, theta_m=theta, theta_l=theta / 50.0, t=t, rows=None)
    return found, find_strokes(found)


@pytest.mark.parametrize("hz", [12.0, 30.0, 45.7, 80.0, 120.0])
def test_hunting_is_seen_at_its_size_and_frequency_whatever_the_frequency(hz: float) -> None:
    judged = smoothness(*motion(0.15, hz))
    assert judged is not None
    assert judged.sigma == pytest.approx(0.15, rel=0.1)
    assert judged.hunts
    assert judged.hunting_hz == pytest.approx(hz, abs=1.0)
    assert not judged.passed


def test_counting_noise_alone_is_not_ripple() -> None:
    judged = smoothness(*motion(0.0, 10.0))
    assert judged is not None
    assert judged.sigma < 0.01
    assert judged.passed
    assert not judged.hunts
