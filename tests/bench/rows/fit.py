"""Row 7: the kinematic-error fit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, final

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.orders.sums import BLOCK, fit, harmonics
from tests.bench.figure import AtMost, Figure, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds, cpu, peak_mib, take_turns

ORDERS = 15  # of Eq. 8; with constant, torque, sign and speed 34 unknowns
GROWTH_ROUNDS = 3  # the long side takes seconds


@dataclass(frozen=True)
class Slow:
    """A slow run forth and back, made up: angle [rad], torque [N·m], direction, speed [rad/s], error [rad]."""

    theta: Array
    tau: Array
    side: Array
    omega: Array
    error: Array
    room: Array  # (34, BLOCK) for the columns of every block, as `rig.analysis.orders.revolutions` keeps it

    @classmethod
    def of(cls, n: int) -> Slow:
        """`n` samples at 1 kHz and 1 rad/s, 8 turns either way whatever `n`."""
        rng = np.random.default_rng(7)
        side = np.where(np.arange(n) < n // 2, 1.0, -1.0)
        theta = np.cumsum(side) * (32.0 * np.pi / n)
        tau, omega = 0.5 * side + rng.normal(0.0, 0.7, n), side + rng.normal(0.0, 0.03, n)
        error = 1e-4 * np.sin(2.0 * theta + 0.3) + tau / 7160.0 + rng.normal(0.0, 1e-5, n)
        return cls(theta, tau, side, omega, error, np.empty((4 + 2 * ORDERS, BLOCK)))

    def columns(self, lo: int, hi: int) -> Array:
        """(34, hi − lo)."""
        columns = self.room[:, : hi - lo]
        columns[0] = 1.0
        columns[1], columns[2], columns[3] = self.tau[lo:hi], self.side[lo:hi], self.omega[lo:hi]
        harmonics(self.theta[lo:hi], ORDERS, columns[4:])
        return columns

    def ours(self) -> Array:
        """By sums over blocks."""
        return fit(self.columns, self.error)

    def lstsq(self) -> Array:
        """As one writes it: the whole matrix."""
        angles = np.outer(self.theta, np.arange(1, ORDERS + 1))
        plain = np.stack((np.ones(self.theta.size), self.tau, self.side, self.omega), axis=1)
        matrix = np.concatenate((plain, np.cos(angles), np.sin(angles)), axis=1)
        return np.asarray(np.linalg.lstsq(matrix, self.error, rcond=None)[0])


@final
class Fit(Row):
    """Blocks of 8000 rows that stay in the cache, normal equations summed: no sample is kept, none is seen twice.

    Found and mended: with 8192 rows the columns lay a power of two apart and shared the same few lines of the cache;
    their product took 0.57 ms, with 8000, 8200 or 6000 it takes 0.49 ms, the whole fit 0.9 of before. The columns are
    written where they stay, as in an analysis, and not joined from pieces in fresh memory: 0.81 to 0.82 of before.
    Found: half of the time is the product of the columns with themselves (as fast as BLAS is on one thread), the
    rest makes the columns. Sums of exponentials alone would halve it again; nobody would feel 17 ms of 400 s.
    """

    number: ClassVar[int] = 7
    name: ClassVar[str] = "kinematic-error fit, 34 unknowns, 4e5 samples; growth to 4e7"
    against: ClassVar[str] = "numpy lstsq"

    def measure(self, rounds: Rounds) -> list[Figure]:
        short = Slow.of(rounds.size(400_000, 40_000))
        cost = take_turns({"ours": cpu(short.ours), "lstsq": cpu(short.lstsq)}, rounds.count)
        theirs = short.lstsq()
        apart = float(np.max(np.abs(short.ours() - theirs)) / np.max(np.abs(theirs)))
        return [
            ratio("CPU time over lstsq", cost["ours"], cost["lstsq"], AtMost(0.08)),
            Figure("largest difference of a coefficient, over the largest coefficient", [apart], AtMost(1e-9), ""),
            *self._growth(short, rounds),
        ]

    def _growth(self, short: Slow, rounds: Rounds) -> list[Figure]:
        times = rounds.size(100, 10)
        long = Slow.of(short.theta.size * times)

        def repeated() -> None:
            for _ in range(times):
                short.ours()

        count = min(rounds.count, GROWTH_ROUNDS)
        cost = take_turns({"long": cpu(long.ours), "short": cpu(repeated)}, count)
        return [
            ratio(
                f"time per sample, {long.theta.size:.0e} over {short.theta.size:.0e}",
                cost["long"],
                cost["short"],
                AtMost(1.15),
            ),
            Figure("memory beside the samples", [peak_mib(long.ours)], AtMost(16.0), "MiB"),
        ]
