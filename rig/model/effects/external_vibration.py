"""A torque on the load at a fixed frequency, whatever the speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic, parameter


class ExternalVibration(Effect):
    """The load feels A·cos(2π·f·t + φ): the floor, a fan, another machine. φ is each run's own, for nothing ties the
    start of a run to it. A gear's own errors follow an angle, so that runs of different speed tell the two apart.
    """

    name: ClassVar[str] = "external_vibration"
    in_short: ClassVar[str] = "a torque at a fixed frequency whatever the speed"
    glosses: ClassVar[Mapping[str, str]] = {
        "frequency": "f, frequency of the vibration",
        "torque_amplitude": "amplitude of its torque, on the load unless it is said to act on the motor",
    }
    source: ClassVar[str] = "randall2011"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    each_run: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("frequency",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    LOWEST: Final = 0.8  # Hz; below, a run of 10 s cannot tell a line from drift
    STEP: Final = 0.02  # Hz, a fifth of what a run of 10 s resolves

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Every frequency that is compared: looked for in the spectrum of what is left, not tried one by one."""
        return tuple((float(f),) for f in np.arange(self.LOWEST, reach.band, 1.0))

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """What is compared."""
        return ((self.LOWEST, reach.band),)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of the time since the campaign began."""
        x = 2 * np.pi * shape[0] * signals.t
        return {Port.LOAD_TORQUE: -np.stack([np.cos(x), np.sin(x)], 1)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Frequency and amplitude; a phase is a run's own."""
        along = np.zeros(fit.covariance.shape[0])
        along[2] = 1.0
        amplitude = harmonic(fit, "torque", "N·m")[0]
        return (parameter("frequency", fit.shape[0], fit.half_width(along), "Hz"), amplitude)
