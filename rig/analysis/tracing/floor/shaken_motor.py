"""A line beside the motion that stands in the motor's balance alone: something shakes the motor, or a pick-up does its
reading. What shakes it turns it; of a torque that is only read it knows nothing."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.interference import STEADY, Interference
from rig.analysis.tracing.floor.shaken import Shaken, shaken
from rig.model.effect import Array

FOLLOWS: Final = 0.03  # of the line, what the motor's inertia takes or gives: a loop that holds the speed leaves little
SURE: Final = 5.0  # standard errors, of what it is in the mean of all runs
FEWEST: Final = 3  # runs
SAID: Final = "The torque acts on the motor: the load's balance has none of it, and the motor turns to and fro by it."


def shaken_motor(s: Solution, line: Interference) -> Shaken | None:
    """What makes the `line` in the residuals of `s`; None of one that wanders, that is loudest in another channel, or
    by which the motor does not move."""
    keys = [key for key in line.columns if key[1] == "M" and key in s.keys and not s.design.eq.runs[key[0]].locked]
    if line.channel != "M" or line.apart > STEADY or len(keys) < FEWEST:
        return None
    follows = np.array([_following(s, key, line.columns[key][:, 0]) for key in keys])
    if not abs(follows.mean()) > max(FOLLOWS, SURE * float(follows.std(ddof=1)) / np.sqrt(follows.size)):
        return None
    return shaken(s.design.eq, line, keys, SAID)


def _following(s: Solution, key: Key, wave: Array) -> float:
    """What the motor's inertia takes along the `wave` (n,) in what is left of a run: −1 where its torque knows nothing
    of it, 0 where it does not move by it, and above where a loop answers by more than there is."""
    rows = s.design.eq.rows[key]
    inertia = s.value("J_m") * rows.z[:, rows.at.index(INDEX["J_m"])]
    return float(inertia @ wave) / max(float(wave @ wave), 1e-300)
