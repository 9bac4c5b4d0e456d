"""What of a run that was never compared is noise: all but what goes with the angle, stroke by stroke."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.runs.strokes import strokes
from rig.analysis.tracing.thresholds import FLOOR_LEAST
from rig.model.effect import Array

STRETCHES: Final = 12  # of a stroke: a friction that grows with the load is nearly straight within one


def beside_the_angle(theta: Array, e: Array) -> Array:
    """Rows of `e` (n,) less the mean of their stretch of their stroke along the angle `theta` (n,); as they are where
    there are too few of them."""
    if e.size < FLOOR_LEAST:
        return e
    made = np.array(e)
    for stroke in strokes(theta):
        at = theta[stroke]
        place = np.digitize(at, np.linspace(at.min(), at.max(), STRETCHES + 1)[1:-1])
        count = np.bincount(place, minlength=STRETCHES)
        mean = np.bincount(place, e[stroke], STRETCHES) / np.maximum(count, 1)
        made[stroke] -= mean[place]
    return made
