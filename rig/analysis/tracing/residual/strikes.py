"""Brief events that come as a clock strikes: a drive that looks at its own current, a pump that draws now and then.

A wave of that frequency and a few of its harmonics hold next to nothing of them. Each run has a phase of its own, for
not every clock goes on between runs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.residual.bursts import LENGTH, loud_half_seconds
from rig.core.units import TURN
from rig.model.effect import Array

FEWEST: Final = 5  # in a run: four lie evenly by chance
RUNS: Final = 2  # with so many: at one speed, what is passed once a turn comes evenly as well
TOGETHER: Final = 0.9  # |Σ exp(iφ)| over their number: twenty at random reach 0.6 at one of so many frequencies
FASTEST: Final = 0.5  # Hz: half seconds that stand out are two apart at least
PERIODS: Final = 3.0  # in the longest run at least
FINER: Final = 8  # frequencies tried for each that the longest run tells apart


def striking(eq: Equations, e: Mapping[Key, Array], channel: str) -> float | None:
    """How often [Hz], where runs with several such events have them evenly; None where there is no time, or too few of
    them."""
    if not eq.timed:
        return None
    times = [t for key, x in e.items() if key[1] == channel and (t := strikes(eq, key, x)).size >= FEWEST]
    if len(times) < RUNS:
        return None
    longest = max(float(np.ptp(t)) for t in times)
    hz = np.arange(PERIODS / longest, FASTEST, 1.0 / (FINER * longest))
    sums = [np.abs(np.exp(1j * TURN * np.multiply.outer(hz, t)).sum(1)) for t in times]
    together = np.sum(sums, axis=0) / sum(t.size for t in times)
    return _lowest(hz, together)


def _lowest(hz: Array, together: Array) -> float | None:
    """The top of the lowest peak: events that lie evenly do so at every multiple of their frequency."""
    even = np.flatnonzero(together > TOGETHER)
    if not even.size:
        return None
    first = even[: 1 + int(np.argmax(np.append(np.diff(even), 2) > 1))]
    return float(hz[first[np.argmax(together[first])]])


def strikes(eq: Equations, key: Key, e: Array) -> Array:
    """When [s] a run (n,) has an event: the middle of what stands out, where neighbours are one."""
    t = clock(eq, key)
    since = loud_half_seconds(eq, key, e)
    if not since.size:
        return since
    apart = np.split(since, np.flatnonzero(np.diff(since) > 1.5 * LENGTH) + 1)
    parts = [(t - t[0] >= one[0] - LENGTH) & (t - t[0] < one[-1] + 2.0 * LENGTH) for one in apart]
    return np.array([float(t[part] @ e[part] ** 2 / np.sum(e[part] ** 2)) for part in parts])
