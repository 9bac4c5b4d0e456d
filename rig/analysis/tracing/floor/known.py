"""How well a floor is known: by how many independent parts its differences have, and by how far pairs differ."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import chdtri  # of scipy.stats the import takes half a second

from rig.analysis.tracing.floor.repeats import Scatter

LEAST = 1.0  # degree of freedom: of two repeats whose rows all go together one number is known


def known(found: Sequence[Scatter]) -> tuple[float, float]:
    """95 % interval of the RMS that the pairs have together: of a χ² of as many degrees of freedom as its variance has,
    be that by the rows of each pair or by how pairs scatter      [gum, Eq. G.2b]"""
    weight = np.array([s.rows for s in found], dtype=np.float64)
    weight /= weight.sum()
    squares, freedom = np.array([s.rms**2 for s in found]), np.array([s.freedom for s in found])
    mean = float(weight @ squares)
    by_rows = float(weight**2 @ (2 * squares**2 / np.maximum(freedom, LEAST)))
    among = float(weight**2 @ (squares - mean) ** 2) * len(found) / max(len(found) - 1, 1)
    nu = max(2 * mean**2 / max(by_rows, among, 1e-300), LEAST)
    low, high = (float(np.sqrt(mean * nu / chdtri(nu, tail))) for tail in (0.025, 0.975))
    return low, high
