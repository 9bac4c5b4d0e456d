"""Fig. 2: θ̃ at 300 rpm without load, over the turn of the wave generator."""

from __future__ import annotations

import numpy as np

from rig.analysis.kinematic_error.measure import KinematicError
from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, missing, positive
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.split import THETA_DEG, amplitude, peak_to_peak, words

SPEED_RPM = 300.0
TITLE = "θ̃ at 300 rpm, no load"
PAPER = "A kinematic error that repeats with the wave generator and goes twice up and down in each of its turns."
TWICE = "Twice per turn of the wave generator"
RULE = "Amplitude of order 2 less that of the next largest order, above zero with its 95 % interval."


def figure(campaign: Campaign) -> Exhibit:
    """Every turn, the mean, and whether order 2 is the largest."""
    reading = campaign.at_speed(SPEED_RPM)
    if reading is None or reading.fast is None:
        lacking = f"It takes an unloaded run at {SPEED_RPM:g} rpm, constant torque."
        return Exhibit("Figure 2", TITLE, PAPER, "", (missing(TWICE, lacking),), missing=lacking)
    fast = reading.fast
    curves = {
        "turn.theta_deg": THETA_DEG,
        "turn.revolutions": np.concatenate([s.curves - s.curves.mean(axis=1, keepdims=True) for s in fast.strokes]),
        "turn.measured": fast.profile.fit(),
    }
    how = f"{words(reading, fast)} at {reading.torque:.4f} N·m, {peak_to_peak(fast).value:.1f} arcsec peak to peak."
    return Exhibit("Figure 2", TITLE, PAPER, how, (twice([amplitude(fast, n) for n in orders(fast)]),), "turns", curves)


def orders(fast: KinematicError) -> range:
    """1..k"""
    return range(1, fast.profile.terms + 1)


def twice(amplitudes: list[Number]) -> Claim:
    """From the amplitudes of orders 1.. in order."""
    if len(amplitudes) < 3:
        return missing(TWICE, "Too few orders were resolved.")
    second = amplitudes[1]
    n, rival = max(((n, a) for n, a in enumerate(amplitudes, 1) if n != 2), key=lambda pair: pair[1].value)
    ruling = positive(second.minus(rival))
    return Claim(TWICE, ruling, f"Order 2 has {{}}, the next largest, order {n}, has {{}}.", (second, rival), RULE)
