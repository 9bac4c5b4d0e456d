"""One count of a coarse reading, as the rows themselves show it."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

ROUNDED: Final = 1e-12  # relative: what double precision leaves of two equal angles
SELDOM: Final = 1 / 500  # of the rows: a reading of a hundred counts a turn, of a motor at 9.6 rpm, steps more often


def smallest_step(x: npt.NDArray[np.float64]) -> float:
    """Smallest change of the way from one row to the next that is no rounding of the numbers, 0 where there is none:
    one count of a coarse reading, next to nothing of a fine one. An angle that was commanded or computed changes its
    way where it turns back, and nowhere else: that is no count."""
    steps = np.abs(np.diff(x, 2))
    steps = steps[steps > ROUNDED * np.nanmax(np.abs(x), initial=0.0)]
    return float(np.min(steps)) if steps.size > SELDOM * x.size else 0.0
