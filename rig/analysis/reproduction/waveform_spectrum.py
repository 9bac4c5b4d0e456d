"""θ̃ of a steady run over time as amplitudes by frequency, in cycles per minute as the paper has them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Motion

UP_TO = 12.0  # times the motor's speed: beyond, nothing stands out of the paper's axis
SHORTEST = 8.0  # turns: fewer do not part neighbouring orders under a Hann window


@dataclass(frozen=True)
class Spectrum:
    """Amplitudes [arcsec] at `cpm`, both (n,); `step` cycles per minute from one to the next."""

    cpm: Array
    amplitude: Array
    step: float
    peak: float  # cycles per minute, of the largest, between the steps
    mean_rpm: float  # of the motor over the same rows


def spectrum_of(motion: Motion) -> Spectrum | None:
    """Hann window, straight line taken off; None without time or with too few turns."""
    if motion.t is None or motion.theta_l is None:
        return None
    t = motion.t
    turns = float(motion.theta_m[-1] - motion.theta_m[0]) / (2.0 * np.pi)
    if abs(turns) < SHORTEST:
        return None
    even = np.linspace(t[0], t[-1], t.size)
    error = np.interp(even, t, motion.error_arcsec(0, t.size))
    x = np.linspace(-1.0, 1.0, error.size)
    error = error - np.polyval(np.polyfit(x, error, 1), x)
    window = np.hanning(error.size)
    amplitude = np.abs(np.fft.rfft(error * window)) * (2.0 / window.sum())
    length = float(t[-1] - t[0]) * t.size / (t.size - 1)
    step, rpm = 60.0 / length, abs(turns) * 60.0 / float(t[-1] - t[0])
    keep = max(int(UP_TO * rpm / step), 3)
    found = amplitude[:keep]
    return Spectrum(np.arange(found.size) * step, found, step, _peak(found) * step, rpm)


def _peak(amplitude: Array) -> float:
    """Where the largest line lies, in steps: a parabola through the logarithms, nearly exact under a Hann window."""
    k = int(np.argmax(amplitude[1:-1])) + 1
    a, b, c = np.log(np.maximum(amplitude[k - 1 : k + 2], 1e-300))
    bend = float(a - 2.0 * b + c)
    return k + (0.5 * float(a - c) / bend if bend else 0.0)
