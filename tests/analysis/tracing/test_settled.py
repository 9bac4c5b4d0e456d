"""Where a motor slides for good."""

from __future__ import annotations

import dataclasses

import numpy as np

from rig.analysis.tracing.runs.sliding import settled
from rig.analysis.tracing.thresholds import LOOSE, SETTLING
from tests.contract.test_effects import motion


def test_rows_near_a_stop_have_not_settled() -> None:
    piece = motion(n=2000)
    way = np.ones(2000)
    way[[3, 700, 1700]] = 0.0
    width = max(1, round(SETTLING / piece.dt)) - max(1, round(LOOSE / piece.dt))
    far = np.min(np.abs(np.arange(2000)[:, None] - [3, 700, 1700]), axis=1) > width
    assert 0 < far.sum() < 1990
    assert np.array_equal(settled(dataclasses.replace(piece, way=way)), far)
    assert settled(dataclasses.replace(piece, way=np.ones(2000))).all()
