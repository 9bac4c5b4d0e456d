"""A fixed rich friction model, always the same (the sixth of the BAM ladder): whatever is missing, it is friction."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from tests.blind.peers.data import Rows, Split
from tests.blind.peers.peer import Guess, Peer

SPEEDS = (0.3, 0.6, 1.2, 2.5, 5.0)  # rad/s, Stribeck speeds tried


def columns(rows: Rows, speed: float) -> np.ndarray:
    """Coulomb, viscous, Stribeck, load-dependent and load-dependent Stribeck friction, drag with the square."""
    w, load, side = (rows.of(name)[:, 0] for name in ("w", "T", "side"))
    near, size = np.exp(-np.abs(w) / speed), np.abs(load)
    return np.column_stack([side, w, side * near, side * size, side * size * near, side * load**2 / 40, w * np.abs(w)])


class RichFriction(Peer):
    """Least squares for the coefficients, a grid for the Stribeck speed; the motor's torque only."""

    name: ClassVar[str] = "fixed rich friction model"

    def guess(self, split: Split, channel: str) -> Guess:
        if channel != "tau_m":
            return Guess(np.zeros(len(split.held.y)), frozenset())
        fits = []
        for speed in SPEEDS:
            x = columns(split.train, speed)
            beta = np.linalg.lstsq(x, split.train.y, rcond=1e-10)[0]
            fits.append((float(np.sum((split.train.y - x @ beta) ** 2)), speed, beta))
        _, speed, beta = min(fits, key=lambda fit: fit[0])
        return Guess(columns(split.held, speed) @ beta, frozenset({"friction"}))
