"""What a second mode makes of a signal in a run that was cut out of a longer motion: it swings when the run begins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.model.effect import Signals
from rig.model.memory import resonance
from rig.model.second_mode.shaken import EXCITED

Array = npt.NDArray[np.float64]

ORDERS: Final = 12  # of the motor
TURNS: Final = 2.0  # of the motor, in which they are read
LEAST: Final = 1.0  # s, likewise
STEADY: Final = 0.05  # relative: faster or slower by more in the second half of those turns, the run began otherwise


@dataclass(frozen=True)
class First:
    """How a run goes in its first `rows`: at `omega` rad/s of the motor; `fit` (ORDERS, rows) times a signal are the
    complex amplitudes of the orders in it, as seen where it begins."""

    rows: int
    omega: float
    fit: npt.NDArray[np.complex128]


def swung(s: Signals, x: Array, omega: float, zeta: float) -> tuple[Array, Array]:
    """`x` (n,) through ω²/(s² + 2ζωs + ω²) and the second derivative of that, (n,) each. Where the motor turns steadily
    from the first row on it did so before, and what the orders in `x` make the mode do has built up; else it begins at
    rest. A lightly damped one takes a second to forget where it began.
    """
    x = _between_rows(x)
    after, second = resonance(x, s.dt, omega, zeta, *_in_swing(s, x, omega, zeta))
    return after, second


def _in_swing(s: Signals, x: Array, omega: float, zeta: float) -> tuple[float, float]:
    """How far the mode is behind `x` when the run begins, and how fast it moves, 1/s; (0, 0) at rest."""
    first = s.once("as it began", lambda: _as_it_began(s))
    if first is None:
        return 0.0, 0.0
    waves = first.fit @ x[: first.rows]
    rate = 1j * first.omega * np.arange(1, ORDERS + 1)
    passed = waves * omega**2 / (rate**2 + 2.0 * zeta * omega * rate + omega**2)
    return float((passed - waves).real.sum()), float((passed * rate).real.sum())


def _between_rows(x: Array) -> Array:
    """`x` (n,) so raised that a line from row to row has its waves at full height: of 13 Hz in rows of 4 ms such a line
    lacks 0.9 %, which moves a sharp resonance by a sixth of that."""
    out = np.array(x, dtype=np.float64)
    out[1:-1] -= np.diff(x, 2) / 12.0
    return out


def _as_it_began(s: Signals) -> First | None:
    """None where the motor does not turn, or not steadily, or not for long enough."""
    if s.t.size < 2:
        return None
    ahead = np.abs(s.theta_m - s.theta_m[0])
    rows = max(int(np.searchsorted(np.maximum.accumulate(ahead), TURNS * 2.0 * np.pi)), round(LEAST / s.dt))
    if rows >= s.t.size:
        return None
    half = rows // 2
    halves = np.diff(s.theta_m[[0, half, rows]]) / (np.array([half, rows - half]) * s.dt)
    turning = float(halves.mean())
    if abs(turning) < EXCITED or abs(halves[1] - halves[0]) > STEADY * abs(turning):
        return None
    gone = np.multiply.outer(s.theta_m[:rows] - s.theta_m[0], np.arange(1, ORDERS + 1))
    waves = np.linalg.pinv(np.hstack([np.ones((rows, 1)), np.cos(gone), np.sin(gone)]))
    return First(rows, turning, waves[1 : ORDERS + 1] - 1j * waves[ORDERS + 1 :])
