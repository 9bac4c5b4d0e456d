"""The three residual channels as a page names them: letter of the curves, sensor, name, unit shown, share of rad."""

from __future__ import annotations

from typing import NamedTuple

from rig.analysis.tracing.result import Errors

ARCSEC = 180 * 3600 / 3.141592653589793


class Channel(NamedTuple):
    """One channel."""

    letter: str  # in the names of curves
    sensor: str  # in `Trace.floors` and the ratios
    name: str
    short: str
    unit: str
    factor: float  # from the floor's unit to the one shown

    def error(self, e: Errors) -> float | None:
        """Its RMS error."""
        return {"A": e.kinematic_error_rms_arcsec, "M": e.tau_m_rms, "L": e.tau_l_rms}[self.letter]

    def floor(self, e: Errors) -> float | None:
        """Its floor beside that."""
        return {"A": e.floor_kinematic_error_arcsec, "M": e.floor_tau_m, "L": e.floor_tau_l}[self.letter]


CHANNELS = (
    Channel("A", "theta_l", "Kinematic error", "θ̃", "arcsec", ARCSEC),
    Channel("M", "tau_m", "Motor torque", "τ_m", "N·m", 1.0),
    Channel("L", "tau_l", "Shaft torque", "τ_l", "N·m", 1.0),
)
