"""What a second mode still swings by when a run begins, of the motion before it that nobody recorded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.nameless.law import Nameless
from rig.model.effect import Array, Port, Shape, Signals
from rig.model.second_mode.shaken import EXCITED

LONG: Final = 0.2  # s: a mode that forgets sooner rings in a few rows
PORTS: Final = {Port.MOTOR_TORQUE, Port.LOAD_TORQUE, Port.WIND_UP, Port.READS_THETA_L, Port.READS_THETA_M}


@dataclass(frozen=True)
class RingDown(Nameless):
    """At one port a free oscillation since the run began, e^(−ζωt)·cos(ω_d·t) and the same sine, as large as they are
    in each run: by what it was shaken before nobody knows      [thomson1993]"""

    name: ClassVar[str] = "ring_down"
    in_short: ClassVar[str] = "what a second mode still swings by when a run begins"
    source: ClassVar[str] = "thomson1993"
    each_run: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("omega", "zeta")

    port: Port

    def has_state(self) -> bool:
        """The time since the run began."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Two, (n, 2)."""
        omega, zeta = shape
        since = signals.t - signals.t[0]
        swing = np.exp((-zeta + 1j * np.sqrt(1.0 - zeta**2)) * omega * since)
        return {self.port: np.stack([swing.real, swing.imag], 1)}


def ringing(eq: Equations, terms: Sequence[Term], runs: Sequence[int]) -> dict[Key, Array]:
    """Of each lightly damped mode among `terms`, its free oscillation from the start of every run that begins in
    motion, in the channels it acts on (n, 2q)."""
    found: dict[Key, list[Array]] = {}
    for term in terms:
        swing = term.effect.swings(term.shape)
        if swing is None or swing[0] * swing[1] * LONG > 1.0:
            continue
        for run in runs:
            if _begins_in_motion(eq, run):
                for c, made in _of(eq, run, term, swing).items():
                    found.setdefault((run, c), []).append(made)
    return {key: np.hstack(made) for key, made in found.items()}


def _of(eq: Equations, run: int, term: Term, swing: tuple[float, float]) -> dict[str, Array]:
    """In the channels of one run that the mode itself acts on."""
    ports = term.effect.columns(eq.runs[run].pieces[0], term.shape)
    rings = [Term(RingDown(port), swing) for port in ports if port in PORTS]
    made = [(c, x) for ring in rings for c, x in eq.term(run, ring).items() if np.any(x)]
    return {c: np.hstack([x for channel, x in made if channel == c]) for c in dict(made)}


def _begins_in_motion(eq: Equations, run: int) -> bool:
    piece = eq.runs[run].pieces[0]
    return not eq.runs[run].locked and bool(np.abs(piece.omega_m[: max(round(LONG / piece.dt), 1)]).min() > EXCITED)
