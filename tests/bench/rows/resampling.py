"""Row 8: angular resampling and order spectra."""

from __future__ import annotations

from typing import ClassVar, final

import numpy as np
from scipy.interpolate import CubicSpline

from rig.analysis.findings.result import Array
from rig.analysis.orders.lines import resample, spectrum
from rig.core.units import TURN
from tests.bench.figure import AtMost, Figure, Shown, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds, cpu, peak_mib, take_turns

PER_TURN = 320  # what `spectrum` asks for up to order 40; the rows are 1000 a turn


def turning(n: int) -> tuple[Array, Array]:
    """`n` rows of an angle [rad] whose speed varies by a third, 1000 a turn, and a line of order 7 on it."""
    theta = np.cumsum(TURN / 1000.0 * (1.0 + 0.3 * np.sin(np.arange(n) * 1e-4)))
    return theta, np.sin(7.0 * theta)


def by_spline(theta: Array, y: Array) -> Array:
    """What one writes with scipy: a cubic spline through the rows, at even angles."""
    turns = (theta[-1] - theta[0]) / TURN
    return np.asarray(CubicSpline(theta, y)(np.linspace(theta[0], theta[-1], int(turns * PER_TURN))))


@final
class Resampling(Row):
    """hdrig interpolates nothing where rows are plenty: it averages the rows in each bin, so noise averages down too.

    Found and mended: the bins were counted over whole arrays, whose fresh pages cost more than the counting; by blocks
    that stay in the cache it is a steady 10 to 13 ns a row and needs no memory beside the bins. The spectrum (an FFT
    padded to a power of two) costs two and a half times that, and is set here against the spline's resampling alone.

    Most of the spline's time is not its own: of arithmetic it has 34 to 42 ns a row (ours is then 0.3 of it), and the
    system takes 40 to 280 ns more, from one round to the next, to give it fresh memory. That is what moves the ratio.
    """

    number: ClassVar[int] = 8
    name: ClassVar[str] = "angular resampling and order spectrum, 1e7 samples"
    against: ClassVar[str] = "scipy CubicSpline"

    def measure(self, rounds: Rounds) -> list[Figure]:
        theta, y = turning(rounds.size(10_000_000, 200_000))
        sides = {
            "ours": cpu(lambda: resample(theta, y, PER_TURN)),
            "spectrum": cpu(lambda: spectrum(theta, y)),
            "spline": cpu(lambda: by_spline(theta, y)),
        }
        cost = take_turns(sides, min(rounds.count, 5))
        orders, amplitude = spectrum(theta, y)
        error = abs(float(amplitude[np.abs(orders - 7.0) < 0.5].max()) - 1.0)
        mine, theirs = peak_mib(lambda: resample(theta, y, PER_TURN)), peak_mib(lambda: by_spline(theta, y))
        return [
            ratio("resampling, CPU time over the spline's", cost["ours"], cost["spline"], AtMost(0.15)),
            ratio("resampling and spectrum over the spline alone", cost["spectrum"], cost["spline"], Shown()),
            Figure("memory beside the rows, over the spline's", [mine / theirs], Shown()),
            Figure("error of a line of order 7, relative", [error], Shown(), ""),
        ]
