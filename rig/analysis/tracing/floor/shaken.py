"""What shakes the motor or the load, read from a line beside the motion that the equations bear out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.interference import Interference
from rig.core.quantiles import Z95
from rig.model.effect import Parameter, parameter

READ: Final = 1e-3  # relative: a frequency that is read window by window is known no better in one run


@dataclass(frozen=True)
class Shaken:
    """Usual frequency [Hz] and torque [N·m], each with the half width of its 95 % interval, and what is said of it."""

    frequency: tuple[float, float]
    torque: tuple[float, float]
    said: str

    def parameters(self) -> tuple[Parameter, ...]:
        """As of a steady vibration of the load."""
        return (
            parameter("frequency", *self.frequency, "Hz"),
            parameter("torque_amplitude", *self.torque, "N·m"),
        )


def shaken(eq: Equations, line: Interference, keys: Sequence[Key], said: str) -> Shaken:
    """By the `line` in the blocks `keys`, with what the low-pass takes of it put back."""
    passed = np.exp(-0.5 * (line.frequency_hz / eq.runs[keys[0][0]].smoother.sigma_hz) ** 2)
    sizes = np.array([np.sqrt(2) * np.std(line.columns[key]) for key in keys]) / passed
    spread = Z95 * float(sizes.std(ddof=1)) / np.sqrt(sizes.size)
    half_hz = Z95 * max(line.apart - 1.0, READ) * line.frequency_hz / np.sqrt(sizes.size)
    return Shaken((line.frequency_hz, half_hz), (float(np.median(sizes)), spread), said)
