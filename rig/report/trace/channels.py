"""The three residual channels as a page names them."""

from __future__ import annotations

from typing import NamedTuple

from rig.analysis.tracing.fit.channels import CHANNEL
from rig.analysis.tracing.outcome.result import Errors, Trace
from rig.analysis.tracing.runs.holdout import HELD_PART
from rig.core.units import ARCSEC
from rig.report.numbers import counted


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


def held_out_with(trace: Trace, sensor: str) -> str:
    """How many held-out runs have an error in the channel of `sensor`, or parts of runs where those were held out: a
    locked output has none in the shaft torque."""
    channel = next(c for c in CHANNELS if c.sensor == sensor)
    names = [name for name, e in trace.before.per_run.items() if channel.error(e) is not None]
    parts = sum(HELD_PART in name for name in names)
    whole = [counted(len(names) - parts, "held-out run")] if parts < max(len(names), 1) else []
    of_runs = [f"the held-out {'part' if parts == 1 else 'parts'} of {counted(parts, 'run')}"] if parts else []
    return " and ".join([*whole, *of_runs])
