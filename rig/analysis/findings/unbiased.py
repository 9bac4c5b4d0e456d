"""What noise adds to a size, taken off: a peak to peak or an rms is larger the more its parts scatter."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array


def unbiased(plain: float, drawn: Array) -> tuple[float, float]:
    """The size without that, and 1 σ of it, in its own unit      [gum, Suppl. 1]

    `plain` is the size as found, and `drawn` (n,) the same with noise of the parts' uncertainties added once more: by
    as much as these are larger on average the first is too large itself. Never below zero, and never made larger.
    """
    bias = max(float(drawn.mean()) - plain, 0.0)
    return max(plain - bias, 0.0), float(drawn.std())


def phasor_draws(count: int, size: int) -> Array:
    """Noise of 1 σ in either part of so many phasors, (count, size), complex; the same each time, so that one file has
    one interval."""
    rng = np.random.default_rng(0)
    return np.asarray(rng.standard_normal((count, size)) + 1j * rng.standard_normal((count, size)))
