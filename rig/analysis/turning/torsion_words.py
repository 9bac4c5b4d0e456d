"""Torsion against torque as a person is shown it: figures, lines, curves, and what the run cannot tell."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.collected import Findings
from rig.analysis.findings.result import Array, Estimate
from rig.analysis.motion.source import Motion
from rig.analysis.orders.lines import Line
from rig.analysis.turning.torsion import LOAD_HARMONICS, Torsion, torsion
from rig.core.quantiles import Z95
from rig.core.rows import stretches
from rig.core.units import ARCMIN, ARCSEC

DRAWN = 4000  # points of the loop


def add_torsion(found: Findings, motion: Motion, tau_l: Array | None) -> bool:
    """Add what torsion against torque says, when the shaft torque moves over a sweep; whether it did."""
    if tau_l is None or not all(np.isfinite(tau_l[some]).all() for some in stretches(tau_l.size)):
        return False
    step = 2.0 / motion.ratio  # errors that ride on the other gear wheel stand this far from the whole order
    r = torsion(motion, tau_l, [1.0, 2.0 - step, 2.0, 2.0 + step, 4.0])
    if r is None:
        return False
    how = (
        f"Slope of θ̃ against shaft torque over {r.turns:.0f} motor turns of steady speed, nothing else fitted; "
        "interval by leaving out one twelfth of the sweep at a time."
    )
    label = "Stiffness, apparent (torsion against torque)"
    ci95 = (min(r.interval), max(r.interval))
    found.estimates.append(Estimate("torsional_stiffness_apparent", label, r.stiffness, "N·m/rad", ci95, how))
    label, how = "Torsion, span over the whole sweep", "Largest minus smallest θ̃."
    found.exact("torsion_span", label, r.span / ARCMIN, "arcmin", how)
    label = "Remainder after torsion and output harmonics, rms"
    how = f"rms of θ̃ after torque and {LOAD_HARMONICS} harmonics of the output angle, steady speed."
    found.exact("torsion_remainder_rms", label, r.remainder / ARCMIN, "arcmin", how)
    _add_lines(found, r, motion.ratio)
    _doubts(found, r)
    every = max(r.torque.size // DRAWN, 1)
    ends = np.array([r.torque.min(), r.torque.max()])
    found.curve(
        torsion__torque=r.torque[::every],
        torsion__angle=r.angle[::every] / ARCMIN,
        torsion__fit_torque=ends,
        torsion__fit_angle=(ends - r.torque.mean()) / r.stiffness / ARCMIN,
    )
    return True


def _add_lines(found: Findings, r: Torsion, ratio: float) -> None:
    """The table of lines, and a figure for each that is resolved and at no whole order."""
    found.tables["torsion_lines"] = [_row(line) for line in r.lines]
    for line in r.lines:
        if line.resolved and line.order != round(line.order):
            label = f"Line at order {line.order:.4f} (2 − 2/{ratio:g} of the motor turn)"
            if line.order > 2:
                label = label.replace("−", "+")
            # by itself: fitted together with order 2 the two share their amplitude, being hardly more than 1/span apart
            how = (
                f"Fitted by itself to what torque and output harmonics leave; {r.turns:.0f} turns tell orders "
                f"{line.resolution:.3f} apart, order 2 is {abs(line.order - 2):.3f} away."
            )
            unit, scale = ("arcsec", 1 / ARCSEC) if line.amplitude / ARCMIN < 1.0 else ("arcmin", 1 / ARCMIN)
            half = Z95 * line.u * scale
            found.figure(f"line_order_{line.order:.4f}", label, line.amplitude * scale, unit, half, how)


def _doubts(found: Findings, r: Torsion) -> None:
    if r.stiffness < 0:
        found.cannot.append(
            "The torsion falls as the shaft torque rises: a spring does the opposite, so the sign of the torque or of "
            "one encoder is the wrong way round."
        )
    if not r.separable:
        found.cannot.append(
            f"The torque follows the output angle (variance inflation {r.inflation:.0f}): with {LOAD_HARMONICS} output "
            f"harmonics free, the same rows give {r.stiffness_beside / 1000:.4g} kN·m/rad instead of "
            f"{r.stiffness / 1000:.4g}. Torsion, eccentricity and position-dependent load cannot be separated; the "
            "slope is an apparent stiffness until the same angles are passed at another torque."
        )


def _row(line: Line) -> dict[str, float | str]:
    return {
        "order": line.order,
        "amplitude_arcsec": line.amplitude / ARCSEC,
        "u_arcsec": line.u / ARCSEC,
        "resolution": line.resolution,
        "resolved": "yes" if line.resolved else "no",
    }
