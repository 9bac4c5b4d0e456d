"""Campaigns that do not tell a spring: without a torque sensor, under one load, at one speed or too slow.

What winds the gear up is then the load's inertia alone, told by its encoder twice differentiated. At one speed every
order of it is an order of the kinematic error too. The rest is the encoder's noise, which then stands on both sides of
the regression: with a noise of 0.7 arcsec a gear without any wind-up had 448 ± 34 N·m/rad, and an order 2 of 25 arcsec
in the place of 30.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.cannot import ONE_LOAD, one_speed
from rig.analysis.tracing.runs.recording import Recording

NOISY: Final = 0.5  # of the mean square of a torque, what its noise may be: a fit cannot take off more


def no_spring(runs: Sequence[Recording]) -> bool:
    """Whether no run tells how much the gear winds up."""
    if any("tau_l" in run.has or run.is_wound for run in runs):
        return False
    free = [run for run in runs if not run.locked and {"theta_m", "theta_l"} <= run.has]
    if not free:
        return False
    weights = [float(piece.tau_ext[0]) for run in free for piece in run.pieces]
    return np.ptp(weights) < ONE_LOAD and (one_speed(free) or _is_noise(free))


def _is_noise(runs: Sequence[Recording]) -> bool:
    """Whether the inertia's torque is mostly the noise of the load encoder."""
    torque = [run.smoother(piece.tau_l) for run in runs for piece in run.pieces]
    square = sum(float(np.sum((x - x.mean()) ** 2)) for x in torque)
    noise = sum(
        run.smoother(piece.tau_l).size * (piece.gear.J_l * run.noise["theta_l"] * run.smoother.gain(2)) ** 2
        for run in runs
        for piece in run.pieces
    )
    return noise > NOISY * square


def unweighed_inertia(runs: Sequence[Recording]) -> bool:
    """Whether nobody says what a free load's inertia is, by number or by a torque sensor, and a motor's torque may."""
    told = any("tau_l" in run.has or "J_l" in run.declared for run in runs)
    return not told and any(run.load_unread and {"t", "theta_l"} <= run.has for run in runs)
