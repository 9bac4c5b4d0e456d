"""A line beside the motion that stands in the load's balance alone: something shakes the load, or a pick-up does its
reading. A torque that is only read winds nothing up, so that the wind-up misses it; one that is there does not."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.interference import Interference
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.shaken import Shaken, shaken
from rig.core.quantiles import Z95
from rig.model.effect import Array
from rig.model.linear import held_frequency

MISSED: Final = 0.3  # of what the wind-up misses by a pick-up of either sensor, at most
FEWEST: Final = 3  # runs
SAID: Final = (
    "The vibration wanders in strength, phase or frequency, so that it is read anew every few seconds; the wind-up "
    "shows none of it that the torque sensor does not, so that no pick-up of a sensor makes it."
)


def shaken_load(s: Solution, line: Interference) -> Shaken | None:
    """What makes the `line` in the residuals of `s`; None of one that is loudest in another channel, or that the
    wind-up may miss as it would a pick-up in the torque sensor, or in the load encoder."""
    eq = s.design.eq
    keys = [key for key in line.columns if key[1] == "L" and key in s.keys and (key[0], "A") in s.keys]
    keys = [key for key in keys if not eq.runs[key[0]].locked and "tau_l" in eq.runs[key[0]].knows]
    if line.channel != "L" or len(keys) < FEWEST or s.value("compliance") <= 0:
        return None
    missed = np.array([_missed(s, key, line.columns[key][:, 0]) for key in keys])
    half = Z95 * float(missed.std(ddof=1)) / np.sqrt(missed.size)
    gear = eq.runs[keys[0][0]].gear
    of_the_encoder = (held_frequency(gear.K, gear.J_l) / (2 * np.pi * line.frequency_hz)) ** 2
    if abs(missed.mean()) + half > MISSED * min(1.0, of_the_encoder):
        return None
    return shaken(eq, line, keys, SAID)


def _missed(s: Solution, key: Key, wave: Array) -> float:
    """What the wind-up misses of the `wave` (n,) in the load's balance of a run, over what a pick-up in the torque
    sensor makes it miss: 1 of such a one, 0 of a torque that is there."""
    eq, angle = s.design.eq, (key[0], "A")
    there = np.interp(clock(eq, angle), clock(eq, key), wave)
    along = float(s.residual(angle) @ there) / max(float(there @ there), 1e-300)
    return -along / s.value("compliance")
