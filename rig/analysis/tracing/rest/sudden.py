"""What was there from one moment on: something lodged, slipped or broke."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import numpy as np

from rig.analysis.tracing.rest.binned import Halves
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.rest.joined import Rest
from rig.analysis.tracing.rest.readings import in_columns, share
from rig.model.effect import Array

ENDS: Final = 0.03  # of the rows on each side: of less a step is what one run has to itself


def since(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home:
    """A step at one moment of the campaign, against the `sense` of the motion: the moment is where the sum of what is
    left, about its mean, is furthest from nothing."""
    r = h.rest
    order = np.argsort(r.at["time"], kind="stable")
    left = (h.alone[0] + h.alone[1]) / 2 * sense(r)
    gone = np.cumsum(left[order] - left.mean())
    n, k = left.size, np.arange(1, left.size + 1)
    strength = np.abs(gone) / np.sqrt(np.maximum(k * (n - k), 1) / n)
    strength[: int(ENDS * n)] = strength[n - int(ENDS * n) - 1 :] = 0.0
    moment = float(r.at["time"][order[int(np.argmax(strength))]])
    read = in_columns(lambda rest: ((rest.at["time"] > moment) * sense(rest))[:, None])
    return Home("time", channel, share(h, read), read=read)
