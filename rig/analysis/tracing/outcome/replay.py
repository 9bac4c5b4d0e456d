"""The kinematic error the whole model makes when its motor is led along a run's motion      [ghorbel2001, Fig. 11]

Nothing of the load side is read: load angle and shaft torque are simulated (fit/led.py), and the effects get the
simulated ones. What they make of the torque is found by turns: the motion under the last wind-up a and load torque l of
the effects, then a and l of that motion.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.led import Model, follow, lead
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Port, Signals

SPAN: Final = 8.0  # s of a run: a turn of the slowest motor and more, and quick
TURNS: Final = 25  # of motion and effects, at most
KEPT: Final = 8  # turns whose mixture makes the next
SETTLED: Final = 2e-6  # rad, the worst row: 0.4 arcsec, a tenth of what is left after
GONE: Final = 6.0  # time constants after which the start is forgotten, to a four-hundredth


def replayed(run: Recording, model: Model) -> Array | None:
    """θ̃ (rows,) on the smoothed rows of the run's first piece, SPAN s of it at most; None where the turns of motion and
    effects do not settle."""
    piece = shown(run)
    found = _kinematic_error(piece, replace(model, gear=run.laden(model.gear)))
    return None if found is None else run.smoother(found)


def shown(run: Recording) -> Signals:
    """The part of a run that is simulated."""
    first = run.pieces[0]
    return first.part(slice(0, round(SPAN / first.dt)))


def _kinematic_error(s: Signals, model: Model) -> Array | None:
    """θ̃ as it would be read, on the grid of the piece, (n,)."""
    n, stiff = s.t.size, model.gear.K
    led, x = lead(s, model, np.zeros(n)), np.zeros(2 * n)
    read_m = np.zeros(n)
    mixed = Anderson()
    for _ in range(TURNS):
        moved = follow(s, model, led, x[:n], stiff * x[n:])
        wind_up, load, turned, read_l = _acting(moved, model)
        new = np.concatenate([wind_up, load / stiff])
        missed = max(np.max(np.abs(new - x)), np.max(np.abs(turned - read_m)) / s.ratio)
        if np.any(turned != read_m):
            read_m, led = turned, lead(s, model, turned)
        if missed < SETTLED:
            return np.asarray(s.theta_m / s.ratio - moved.theta_l - read_l)
        x = mixed.next(x, new)
    return None


class Anderson:
    """Fixed point x = g(x) from the last few turns: the mixture of them that misses least      [anderson1965]"""

    def __init__(self) -> None:
        self.seen: list[tuple[Array, Array]] = []

    def next(self, x: Array, g: Array) -> Array:
        """The x to try after g(x) = `g`."""
        self.seen = [*self.seen, (x, g - x)][-KEPT:]
        last, miss = self.seen[-1]
        if len(self.seen) == 1:
            return g
        moves = np.stack([last - a for a, _ in self.seen[:-1]], 1)
        misses = np.stack([miss - m for _, m in self.seen[:-1]], 1)
        weights = np.linalg.lstsq(misses, miss, rcond=1e-10)[0]
        return np.asarray(last + miss - (moves + misses) @ weights)


def _acting(s: Signals, model: Model) -> tuple[Array, Array, Array, Array]:
    """Wind-up with kinematic error [rad], load torque [N·m], and what θ_m and θ_l read too much, (n,)."""
    total = {port: np.zeros(s.t.size) for port in PORTS}
    total[Port.WIND_UP] = model.mesh * s.omega_m
    for term, coefficients in model.terms:
        for port, columns in term.effect.columns(s, term.shape).items():
            if port in total:
                total[port] = total[port] + columns @ coefficients
    both = total[Port.WIND_UP] + total[Port.KINEMATIC_ERROR]
    return both, total[Port.LOAD_TORQUE], total[Port.READS_THETA_M], total[Port.READS_THETA_L]


PORTS: Final = (Port.WIND_UP, Port.KINEMATIC_ERROR, Port.LOAD_TORQUE, Port.READS_THETA_M, Port.READS_THETA_L)
