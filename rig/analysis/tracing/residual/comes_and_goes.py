"""Friction that comes and goes, slower than any run is long, in every run of that time: a room that is cooled by turns,
a pump that feeds a seal.

What repeats differ by is in the floor, so that no run stands out of it; but in the order they were taken the runs
follow a wave, whatever their speed. Friction that scatters, or wanders, does not come round three times.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.special import fdtrc

from rig.analysis.tracing.fit.channels import CHANNEL
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.for_a_while import BY_CHANCE, LARGE, MOSTLY, UNEVEN, what_a_baseline_takes
from rig.analysis.tracing.residual.in_the_floor import overtones
from rig.analysis.tracing.residual.joined import Rest
from rig.analysis.tracing.residual.levels import Runs, left_by_runs
from rig.model.effect import Array

PERIODS: Final = 3.0  # within the campaign at least: a wander comes round twice by chance
RUNS: Final = 3.0  # to a period at least, of runs as they usually follow each other
FINE: Final = 8  # frequencies tried for every whole wave more in the campaign
HARMONICS: Final = 2  # of it: what is switched on and off has more, and a dozen runs have no room for them
NUMBERS: Final = 2 * HARMONICS + 1  # with the frequency
FREE: Final = 8  # degrees of freedom left at least


@dataclass(frozen=True)
class ComesAndGoes:
    """Friction in which channel, by how much more or less than its mean at most [N·m], how often [Hz], and what of the
    difference of runs that is."""

    channel: str
    size: float
    frequency_hz: float
    share: float

    def sentence(self) -> str:
        """What is said of it."""
        return (
            f"Friction in {CHANNEL[self.channel].name} comes and goes by up to {self.size:.2g} N·m every "
            f"{1.0 / self.frequency_hz:.3g} s of the campaign, in all runs, whatever their speed: {self.share:.0%} of "
            "what runs differ by. Repeats differ by it, so that it is in the floor, and no effect of the library does "
            "so."
        )


def comes_and_goes(eq: Equations, rests: Mapping[str, Rest], floors: Mapping[Key, float]) -> ComesAndGoes | None:
    """Of what runs that turn leave, fitted or not, by channel; None where nothing comes and goes."""
    found = []
    for channel, r in rests.items() if eq.timed else ():
        wave = wave_of_runs(left_by_runs(r, UNEVEN))
        if wave is not None:
            hz, size, share = wave
            floor = float(np.median([floors[int(i), channel] for i in np.unique(r.run)]))
            found.append(ComesAndGoes(channel, size * floor, hz, share))
    return max(found, key=lambda one: one.share, default=None)


def wave_of_runs(runs: Runs) -> tuple[float, float, float] | None:
    """How often [Hz] what runs leave comes and goes, half of its swing, over the floor, and the share of what runs
    differ by; None where it does not, or chance does as much."""
    plain, t = what_a_baseline_takes(runs), runs.since
    free = t.size - plain.shape[1] - NUMBERS
    if free < FREE:
        return None
    span, step = float(np.ptp(t)), float(np.median(np.diff(np.sort(t))))
    if min(span, step) <= 0.0:  # all were taken at once
        return None
    tried = np.arange(PERIODS / span, 1.0 / (RUNS * step), 1.0 / (FINE * span))
    if not tried.size:
        return None
    taken, _ = np.linalg.qr(plain)
    left = _beside(taken, runs.left)
    before = max(float(left @ left), 1e-300)

    def fitted(hz: float) -> tuple[float, Array]:
        """The share explained, and the wave."""
        z = overtones(t, hz, HARMONICS)
        own = _beside(taken, z)
        x = np.linalg.lstsq(own, left, rcond=None)[0]
        e = left - own @ x
        return 1.0 - float(e @ e) / before, np.asarray(z @ x)

    share, hz = max((fitted(hz)[0], hz) for hz in tried.tolist())
    size = float(np.ptp(fitted(hz)[1])) / 2.0
    by_chance = tried.size * fdtrc(NUMBERS, free, share / max(1.0 - share, 1e-12) * free / NUMBERS)
    return (hz, size, share) if by_chance < BY_CHANCE and share > MOSTLY and size > LARGE else None


def _beside(taken: Array, x: Array) -> Array:
    """What of `x` (k,) or (k, n) no column of the orthonormal `taken` (k, m) explains."""
    return np.asarray(x - taken @ (taken.T @ x))
