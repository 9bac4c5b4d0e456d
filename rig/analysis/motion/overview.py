"""The run over time, thinned so that no peak is lost: minimum and maximum of every piece."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion, Source
from rig.analysis.motion.speed import Speed
from rig.core.rows import STRETCH
from rig.core.units import DEG, RPM

POINTS = 2000  # of every curve
Index = npt.NDArray[np.int64]


def pieces(rows: int, points: int = POINTS) -> Index:
    """First rows of at most `points` equal pieces."""
    return np.arange(0, rows, max(-(-rows // points), 1), dtype=np.int64)


def _extremes(x: Array, starts: Index) -> tuple[Array, Array]:
    return np.asarray(np.fmin.reduceat(x, starts)), np.asarray(np.fmax.reduceat(x, starts))


def _behind(reference: Array, theta: Array, starts: Index) -> tuple[Array, Array]:
    """Minimum and maximum of reference less angle [deg] in each piece; some pieces at a time, for runs of hours."""
    found, together = [], max(STRETCH * starts.size // theta.size, 1)
    for first in range(0, starts.size, together):
        here = starts[first : first + together]
        rows = slice(here[0], starts[first + together] if first + together < starts.size else theta.size)
        found.append(_extremes((reference[rows] - theta[rows]) / DEG, here - here[0]))
    return np.concatenate([low for low, _ in found]), np.concatenate([high for _, high in found])


def _speed_extremes(speed: Speed, starts: Index) -> tuple[Array, Array]:
    """Minimum and maximum speed [rpm] in each piece of rows; pieces without a value of their own take the next one."""
    first = np.minimum(np.searchsorted(speed.row, starts), speed.t.size - 1)
    unique, back = np.unique(first, return_inverse=True)
    low, high = _extremes(speed.omega / RPM, unique)
    return low[back], high[back]


def add_overview(found: Findings, run: Source, motion: Motion, speed: Speed | None) -> None:
    """The "time.…" curves; nothing without a time column."""
    t = motion.t
    if t is None or t.size < 2:
        return
    starts = pieces(t.size)
    found.curve(time__t=t[starts], time__theta_m_deg=motion.theta_m[starts] / DEG)
    reference = motion.pick(run.column("theta_ref"))
    if reference is not None and np.isfinite((behind := _behind(reference, motion.theta_m, starts))[0]).any():
        found.curve(time__theta_ref_deg=reference[starts] / DEG)
        found.curve(time__following_error_min=behind[0], time__following_error_max=behind[1])
    if speed is not None and speed.t.size:
        low, high = _speed_extremes(speed, starts)
        found.curve(time__speed_min=low, time__speed_max=high)
    for name in ("tau_m", "tau_l"):
        tau = motion.pick(run.column(name))
        if tau is not None and np.isfinite((reached := _extremes(tau, starts))[0]).any():
            found.curve(**{f"time__{name}_min": reached[0], f"time__{name}_max": reached[1]})
