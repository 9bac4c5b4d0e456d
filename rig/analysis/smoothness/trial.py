"""How evenly a recorded run turned the motor, and nothing else: what tuning asks of a trial."""

from __future__ import annotations

from rig.analysis.motion.source import Source, motion_of
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.smoothness.measure import Smoothness, smoothness


def smoothness_of(run: Source) -> Smoothness | None:
    """None when the motor made no whole turn between two reversals."""
    motion = motion_of(run)
    if motion is None:
        return None
    return smoothness(motion, find_strokes(motion), motion.pick(run.column("theta_ref")))
