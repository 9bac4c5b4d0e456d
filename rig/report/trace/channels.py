"""The three residual channels as a page names them."""

from __future__ import annotations

from typing import NamedTuple

from rig.analysis.tracing.fit.channels import CHANNEL
from rig.analysis.tracing.outcome.result import Errors, Trace
from rig.core.units import ARCSEC


class Channel(NamedTuple):
    """One channel. `factor` goes from the floor's unit to the one shown, `scale` from the errors' and the curves'."""

    letter: str  # in the names of curves
    sensor: str  # in `Trace.floors` and the ratios
    name: str
    short: str
    unit: str
    factor: float
    scale: float

    def error(self, e: Errors) -> float | None:
        """Its RMS error, in the unit shown."""
        found = {"A": e.kinematic_error_rms_arcsec, "M": e.tau_m_rms, "L": e.tau_l_rms}[self.letter]
        return None if found is None else found * self.scale

    def floor(self, e: Errors) -> float | None:
        """Its floor beside that."""
        found = {"A": e.floor_kinematic_error_arcsec, "M": e.floor_tau_m, "L": e.floor_tau_l}[self.letter]
        return None if found is None else found * self.scale


def _shown(letter: str, short: str, unit: str, factor: float, scale: float) -> Channel:
    of = CHANNEL[letter]
    return Channel(letter, of.key, of.name.capitalize(), short, unit, factor, scale)


CHANNELS = (
    _shown("A", "θ̃", "arcsec", 1 / ARCSEC, 1.0),
    # the motor's friction is a few hundredths of a N·m, its floor a few thousandths
    _shown("M", "τ_m", "mN·m", 1e3, 1e3),
    _shown("L", "τ_l", "N·m", 1.0, 1.0),
)


def held_out_with(trace: Trace, sensor: str) -> int:
    """How many held-out runs have an error in the channel of `sensor`: a locked output has none in the shaft torque."""
    channel = next(c for c in CHANNELS if c.sensor == sensor)
    return sum(channel.error(e) is not None for e in trace.before.per_run.values())
