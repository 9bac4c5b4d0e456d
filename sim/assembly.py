"""What assembly makes of the gear: the wave generator's depth, and a kinematic error that is never quite the same."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from rig.model.fourier import FourierSeries
from sim.parameters import TwinParameters


def assembled(made: TwinParameters, depth_mm: float, chance: np.random.Generator) -> TwinParameters:
    """`made` put together once more at `depth_mm`: C_n·(1 + ε_n) and ψ_n + δ_n, ε and δ drawn from `chance`."""
    assembly, error = made.effects.assembly, made.gear.kinematic_error
    epsilon, delta = chance.standard_normal((2, len(error.orders)))
    amplitude = error.amplitude * (1.0 + assembly.scatter * epsilon)
    phase = error.phase + math.radians(assembly.scatter_deg) * delta
    gear = dataclasses.replace(made.gear, kinematic_error=FourierSeries.from_polar(amplitude, phase))
    at_depth = dataclasses.replace(assembly, depth_mm=depth_mm)
    return dataclasses.replace(made, gear=gear, effects=dataclasses.replace(made.effects, assembly=at_depth))
