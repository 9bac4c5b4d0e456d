"""The torque sensor over the wave-generator angle: what bends the gear, apart from both encoders."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.orders.sums import harmonics
from rig.analysis.orders.wave import wave
from rig.model.fourier import PAPER_ORDERS

Complex = npt.NDArray[np.complex128]


@dataclass(frozen=True)
class Shaft:
    """Orders of τ_l as Re Σ z_n·exp(jnθ_m), N·m, (k,); `u` 1 σ of one part of each, from revolution to revolution."""

    orders: Complex
    u: Array
    revolutions: int
    mean: float  # N·m
    mean_size: float  # N·m, mean of |τ_l|
    swing: float  # N·m, peak to peak of the orders over a turn


def shaft_of(motion: Motion, tau_l: Array | None) -> Shaft | None:
    """Least squares revolution by revolution over the longest stroke; None without a whole torque or three turns."""
    strokes = find_strokes(motion)
    if tau_l is None or not np.isfinite(tau_l).all() or not strokes:
        return None
    longest = max(strokes, key=lambda s: s.revolutions)
    pieces = list(pairwise(int(e) for e in longest.edges))
    terms = min(PAPER_ORDERS, min(b - a for a, b in pieces) // 4)
    if len(pieces) < 3 or terms < 1:
        return None
    each = np.array([_orders(motion.theta_m[a:b], tau_l[a:b], terms) for a, b in pieces])
    mean, root = each.mean(axis=0), np.sqrt(len(pieces))
    u = np.sqrt(0.5 * (each.real.var(axis=0, ddof=1) + each.imag.var(axis=0, ddof=1))) / root
    rows = tau_l[pieces[0][0] : pieces[-1][1]]
    return Shaft(
        mean, u, len(pieces), float(rows.mean()), float(np.abs(rows).mean()),
        float(np.ptp(wave(mean))),
    )  # fmt: skip


def _orders(theta: Array, tau: Array, terms: int) -> Complex:
    columns = np.concatenate((np.ones((1, theta.size)), harmonics(theta, terms)))
    found = np.linalg.lstsq(columns.T, tau, rcond=None)[0]
    return np.asarray(found[1 : 1 + terms] - 1j * found[1 + terms :])
