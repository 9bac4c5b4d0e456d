"""Fig. 3: the same θ̃ by frequency, in cycles per minute."""

from __future__ import annotations

import math

from rig.analysis.reproduction.campaign import Campaign
from rig.analysis.reproduction.claim import Claim, Number, covers, missing
from rig.analysis.reproduction.exhibit import Exhibit
from rig.analysis.reproduction.figure_2 import SPEED_RPM
from rig.analysis.reproduction.reading import Reading
from rig.core.quantiles import Z95

TITLE = "Spectrum of θ̃ at 300 rpm"
PAPER = "The strongest line lies at twice the speed of the motor: 600 cycles per minute at 300 rpm."
CLAIM = "The strongest line is at twice the motor's speed"
RULE = (
    "The strongest line less twice the mean speed; its interval is half a step of the spectrum and 1.96 σ of twice the "
    "turns' own speeds, over which a line at constant torque is smeared."
)


def figure(campaign: Campaign) -> Exhibit:
    """The amplitudes and where the largest lies."""
    reading = campaign.at_speed(SPEED_RPM)
    if reading is None or reading.spectrum is None:
        lacking = f"It takes an unloaded run at {SPEED_RPM:g} rpm with time."
        return Exhibit("Figure 3", TITLE, PAPER, "", (missing(CLAIM, lacking),), missing=lacking)
    s = reading.spectrum
    curves = {"spectrum.cpm": s.cpm, "spectrum.cpm_amplitude": s.amplitude}
    how = f"{reading.name}; Hann window over the settled part, one step is {s.step:.2f} cycles per minute."
    claims = (strongest(s.peak, s.mean_rpm, s.step, wander(reading)),)
    return Exhibit("Figure 3", TITLE, PAPER, how, claims, "spectrum-cpm", curves)


def wander(reading: Reading) -> float:
    """1 σ of the speeds of single turns [rpm]."""
    assert reading.fast is not None
    speeds = [float(x) for stroke in reading.fast.strokes for x in stroke.speed_rpm]
    mean = sum(speeds) / len(speeds)
    return math.sqrt(sum((x - mean) ** 2 for x in speeds) / max(len(speeds) - 1, 1))


def strongest(peak: float, mean_rpm: float, step: float, sigma_rpm: float) -> Claim:
    """`peak` and `step` in cycles per minute."""
    half = math.hypot(0.5 * step, Z95 * 2.0 * sigma_rpm)
    line = Number.of(peak, half, "cycles/min")
    off = Number.of(peak - 2.0 * mean_rpm, half, "cycles/min")
    words = f"Strongest line at {{}}; twice the mean speed of {mean_rpm:.1f} rpm is {2 * mean_rpm:.1f} cycles/min."
    return Claim(CLAIM, covers(off, 0.0), words, (line,), RULE)
