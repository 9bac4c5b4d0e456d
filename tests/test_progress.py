"""The live figure: peak to peak of turns passed through one way, nothing else."""

from __future__ import annotations

import math

import pytest

from rig.commands.progress import LivePeakToPeak
from rig.core.sample import Sample

ARCSEC = math.pi / 180 / 3600


def sample(theta_m: float, offset: float = 0.0) -> Sample:
    error = 40 * ARCSEC * math.sin(2 * theta_m) + offset
    return Sample(0.0, theta_m, theta_m / 50 - error, 1.0, 0.3, 1.0, 0.0, 0, 0, 0, "")


def test_it_is_the_peak_to_peak_of_the_last_whole_turn() -> None:
    peak = LivePeakToPeak(50.0)
    assert str(peak) == "p-p –"
    for k in range(200):
        peak.add(sample(0.1 * k))
    assert peak.value == pytest.approx(80 * ARCSEC, rel=0.02)
    assert str(peak).endswith("arcsec")


def test_a_reversal_and_its_offset_do_not_count() -> None:
    peak = LivePeakToPeak(50.0)
    for k in range(200):
        peak.add(sample(0.1 * k))
    for k in range(200):
        peak.add(sample(20.0 - 0.1 * k, offset=60 * ARCSEC))
        assert peak.value == pytest.approx(80 * ARCSEC, rel=0.02)
