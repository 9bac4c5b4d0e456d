"""The kinematic error as the lock test sees it: its slope passes for torsion, for the motor turns while it winds up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.findings.result import Array
from rig.analysis.stiffness.curve import Curve
from rig.analysis.stiffness.points import Points
from rig.analysis.stiffness.share import Share
from rig.core.quantiles import Z95
from rig.core.units import ARCSEC

ORDERS = ((2, 90.0 * ARCSEC), (4, 22.5 * ARCSEC))  # amplitudes [rad] of an older gear, 3 arcmin peak to peak
FLAT = Z95 / np.sqrt(3.0)  # from the bound of an even distribution to the half width of 95 %


@dataclass(frozen=True)
class Tilt:
    """Relative half width (95 %) that the kinematic error leaves on slopes, and how it was dealt with."""

    secant: float
    zones: tuple[float, float, float]  # of K1, K2, K3
    words: str


def unknown_tilt(ratio: float, swing: float) -> float:
    """Largest relative slope N·θ̃_p′ that a line over ±`swing` rad of the motor can mistake for torsion.

    A line through C·sin(nθ) over ±A has the slope C·n·g(nA), g(x) = 3·(sin x − x·cos x)/x³, which falls from 1.
    """
    total = 0.0
    for n, amplitude in ORDERS:
        x = max(n * swing, 1e-3)
        total += n * amplitude * abs(3.0 * (np.sin(x) - x * np.cos(x)) / x**3)
    return float(ratio * total)


def known_tilt(error: Array, windup: Array) -> float:
    """Slope of the subtracted error against the wind-up, both rad (n,): what subtracting it changed, as a share."""
    x = windup - windup.mean()
    return float(x @ (error - error.mean())) / float(x @ x)


def without_reference(ratio: float, swing: float, why: str) -> Tilt:
    """Bounds for an older gear; `why` the reference was not used, "" when there was none."""
    whole, local = FLAT * unknown_tilt(ratio, swing), FLAT * unknown_tilt(ratio, 0.0)
    return Tilt(
        float(whole),
        (float(local), float(local), float(local)),
        f"{why}The slope of the kinematic error at this motor angle is not known: ±{100 * whole:.1f} % of the secant "
        f"and ±{100 * local:.1f} % of K1, K2 and K3 are in the intervals for it (--reference takes it off).",
    )


def with_reference(points: Points, share: Share, lines: Curve) -> Tilt:
    """The subtracted slopes times how well the share of the error is known."""
    relative = share.half / max(share.value, 0.1)
    fitted = (
        "it is taken to be the same under load within 25 %, and the motor angle's zero to be the same in both runs "
        "(the encoder not switched off between): this run turns too little to tell"
    )
    if share.fitted:
        fitted = f"this run shows {share.value:.3f} ± {share.half:.2g} of it, and that was subtracted"
    u = np.abs(points.windup - lines.middle)
    n = lines.law.numbers(lines.p, lines.scale)
    first = n["T1"] / n["K1"]
    second = first + (n["T2"] - n["T1"]) / n["K2"]
    edges = ((0.0, first), (first, second), (second, np.inf))
    k1, k2, k3 = (relative * _zone(points, lines.middle, (u >= a) & (u < b)) for a, b in edges)
    whole = relative * abs(known_tilt(points.error, points.windup))
    return Tilt(whole, (k1, k2, k3), f"The kinematic error of the slow run was subtracted; {fitted}.")


def _zone(points: Points, middle: float, where: npt.NDArray[np.bool_]) -> float:
    """Slope of the subtracted error in one zone, both signs of torque averaged."""
    sides = (where & (points.windup > middle), where & (points.windup <= middle))
    found = [known_tilt(points.error[s], points.windup[s]) for s in sides if s.sum() > 3]
    return abs(float(np.mean(found))) if found else 0.0
