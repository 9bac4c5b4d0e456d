"""What a gear file holds: an identified gear, every number with its 95 % interval, its origin and its runs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from rig.model.fourier import FourierSeries
from rig.model.gear import SIGMA, USUAL, Gear, sigma_of

SCHEMA = "hdrig.gear/1"
ORIGINS = ("measured", "declared", "assumed")
UNITS = {
    "N": "1",
    "J_m": "kg·m²",
    "J_l": "kg·m²",
    "K": "N·m/rad",
    "B_m": "N·m·s/rad",
    "B_ml": "N·m·s/rad",
    "B_l": "N·m·s/rad",
    "B_sp": "N·m·s/rad",
    "tau_c": "N·m",
    "tau_s": "N·m",
    "omega_s": "rad/s",
    "F_cl": "N·m",
}
"""The parameters of equations 5-7 and of the rig's friction, and the only unit each may have."""

CHARACTERISTICS = {
    "tau_break": "N·m",  # at the motor, from rest
    "lost_motion": "rad",  # at the output
    "hysteresis_loss": "rad",  # at the output, gap at zero torque
    "hysteresis_energy": "J",  # per cycle
    "K1": "N·m/rad",
    "K2": "N·m/rad",
    "K3": "N·m/rad",
    "T1": "N·m",
    "T2": "N·m",
}
"""What a gear may have beside them, where it was measured: the simulation does without."""


@dataclass(frozen=True)
class Parameter:
    """One number: `value`, the ends of its 95 % interval (NaN where none was measured), where it comes from."""

    value: float
    interval: tuple[float, float] = (math.nan, math.nan)
    origin: str = "measured"
    runs: tuple[str, ...] = ()
    note: str = ""

    @property
    def half(self) -> float:
        """Half the width of the interval; NaN where there is none."""
        return 0.5 * (self.interval[1] - self.interval[0])


@dataclass(frozen=True)
class MeasuredSeries:
    """θ̃_p of Equation 8 with the covariance of (a_1..a_k, b_1..b_k), rad², (2k, 2k)."""

    series: FourierSeries
    covariance: npt.NDArray[np.float64]
    origin: str = "measured"
    runs: tuple[str, ...] = ()
    note: str = ""


COVERED = {"speed_rpm": "rpm of the motor", "load": "N·m on the output"}


@dataclass(frozen=True)
class Covered:
    """Least and largest of the runs a gear was identified from: |speed| of the motor, rpm, and external torque on the
    output, N·m. Beyond it the file's numbers are a guess."""

    speed_rpm: tuple[float, float]
    load: tuple[float, float]


@dataclass(frozen=True)
class GearFile:
    """An identified gear. `cannot`: what the runs could not tell apart, one sentence each."""

    parameters: Mapping[str, Parameter]
    kinematic_error: MeasuredSeries
    output: str = USUAL
    serial: str = ""
    simulated: bool = False
    made: str = ""  # when and with what, for people
    cannot: tuple[str, ...] = field(default=())
    characteristics: Mapping[str, Parameter] = field(
        default_factory=dict
    )  # those of CHARACTERISTICS that were measured
    covered: Covered | None = None

    def gear(self) -> Gear:
        """The values alone, for simulation."""
        numbers = {name: p.value for name, p in self.parameters.items() if name != "N"}
        return Gear(
            ratio=self.parameters["N"].value,
            kinematic_error=self.kinematic_error.series,
            sigma=sigma_of(self.output),
            **numbers,
        )


def declared(gear: Gear, origin: str = "declared", serial: str = "", simulated: bool = False) -> GearFile:
    """A gear whose numbers nobody measured here, as a gear file."""
    numbers = {name: Parameter(gear.ratio if name == "N" else getattr(gear, name), origin=origin) for name in UNITS}
    size = 2 * len(gear.kinematic_error.a)
    series = MeasuredSeries(gear.kinematic_error, np.full((size, size), math.nan), origin)
    output = next(name for name, sigma in SIGMA.items() if sigma == gear.sigma)
    return GearFile(numbers, series, output, serial, simulated)
