"""What one count of the motor's encoder leaves open of the loop's width."""

from __future__ import annotations

import math

import numpy as np

from rig.analysis.motion.declared import declared
from rig.analysis.motion.source import Motion, Source
from rig.core.units import TURN

PLACE = 1.0 - math.sqrt(0.05)  # counts: 95 % of a triangle of ± one count, the difference of two places within a count


def one_count(run: Source, motion: Motion) -> float:
    """Of the motor's encoder, rad at the output: as the run says, else the least step it shows; 0 without steps."""
    counts = declared(run.manifest.get("encoders") or {}, "motor_counts_per_rev")
    if counts is not None:
        return TURN / counts / motion.ratio
    steps = np.abs(np.diff(motion.theta_m))
    return float(np.min(steps[steps > 1e-9], initial=TURN)) / motion.ratio if (steps > 1e-9).any() else 0.0


def of_width(count: float) -> float:
    """Half of the 95 % interval [rad] of the wind-up between two branches, that no averaging makes smaller.

    A motor that sticks stands where friction stopped it, at one end of a count on the way up and at the other on the
    way down, count after count: each branch may lie anywhere within half a count of where it was read.
    """
    return PLACE * count
