"""Line counts of encoders as the residual shows them: an interpolator need not divide by what the manifest says."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.runs.strokes import strokes
from rig.analysis.tracing.thresholds import LINE
from rig.core.units import TURN
from rig.model.effect import Array, Reach
from rig.model.effects.encoder_interpolation_error import EncoderInterpolationError

SLOW: Final = 2.0  # times the slowest run: faster ones sample the lines too seldom to find them
PEAKS: Final = 2  # of each encoder: the lines and their second wave
FEWEST: Final = 2.0  # periods of the fewest lines that a stroke must hold
AROUND: Final = 2.0  # widths of a peak, within which the whole number is looked for
FINEST: Final = 4  # points of the spectrum per width
BLOCKS: Final = 40  # of the spectrum: each holds a hundred widths and more
MOST_POINTS: Final = 20_000  # of the spectrum: sixteen turns of the motor in orders up to a thousand


def with_lines(covered: Reach, s: Solution, runs: Sequence[int]) -> Reach:
    """The reach with the line counts that the angle equation's residual shows in the slow runs of `runs`."""
    eq = s.design.eq
    slowest = min((eq.runs[i].turning for i in runs if not eq.runs[i].locked), default=0.0)
    keys = [(i, "A") for i in runs if (i, "A") in s.keys and _is_slow(eq, i, slowest)]
    if not keys or slowest <= 0:
        return covered
    found = {name: _counts(s, keys, name, covered) for name in ("theta_m", "theta_l")}
    return replace(covered, lines_m=found["theta_m"], lines_l=found["theta_l"])


def _is_slow(eq: Equations, run: int, slowest: float) -> bool:
    return not eq.runs[run].locked and eq.runs[run].turning < SLOW * slowest


def _counts(s: Solution, keys: Sequence[Key], name: str, covered: Reach) -> tuple[int, ...]:
    """Whole numbers of periods per turn of that angle that stand out, the strongest first."""
    least = float(EncoderInterpolationError.LEAST[name == "theta_l"])
    highest = EncoderInterpolationError.highest(covered, name == "theta_l")
    # an encoder that stands still, or nearly, has no orders: its peaks would be wider than all that is looked at
    parts = [(x, e) for key in keys for x, e in _parts(s, key, name) if np.ptp(x) * least > FEWEST * TURN]
    if not parts or highest <= least:
        return ()
    width = TURN / float(np.median([np.ptp(x) for x, _ in parts]))
    orders = np.linspace(least, highest, int(np.clip(FINEST * (highest - least) / width, 2, MOST_POINTS)))
    power = sum((_power(x, e, orders) for x, e in parts), np.zeros(orders.size))
    power = power / np.maximum(_surroundings(power), 1e-300)
    out: list[int] = []
    for _ in range(PEAKS):
        top = float(orders[int(np.argmax(power))])
        if power.max() < 1.0 + LINE / np.sqrt(len(parts)):  # strokes scatter so much less together
            break
        near = np.arange(max(1, np.ceil(top - AROUND * width)), top + AROUND * width + 1)
        out.append(int(near[int(np.argmax(_together(parts, near)))]))
        power[np.abs(orders - top) < 2 * AROUND * width] = 0.0
    return tuple(out)


def _parts(s: Solution, key: Key, name: str) -> list[tuple[Array, Array]]:
    """Angle (n,) and residual (n,) of every stroke of a run."""
    eq = s.design.eq
    run, r = eq.runs[key[0]], eq.rows[key]
    angle = np.concatenate([getattr(p, name)[run.smoother.centres(p.t.size)] for p in run.pieces])[r.keep]
    e = s.residual(key)
    return [(angle[part], e[part] - e[part].mean()) for part in strokes(r.theta_m)]


def _power(x: Array, e: Array, orders: Array) -> Array:
    """Power of a stroke's residual at `orders`, from rows spread evenly over the angle, (k,)."""
    rising = np.maximum.accumulate(x if x[-1] > x[0] else -x)
    even = np.interp(np.linspace(rising[0], rising[-1], x.size), rising, e) * np.hanning(x.size)
    spectrum = np.abs(np.fft.rfft(even, 2 * x.size)) ** 2
    at = np.arange(spectrum.size) * TURN / (2.0 * (rising[-1] - rising[0]))
    return np.asarray(np.interp(orders, at, spectrum, right=0.0))


def _surroundings(power: Array) -> Array:
    """Median of the blocks around each point: the low-pass leaves no white noise, (k,)."""
    size = max(1, power.size // BLOCKS)
    middles = [float(np.median(power[i : i + size])) for i in range(0, power.size, size)]
    return np.asarray(np.interp(np.arange(power.size), np.arange(len(middles)) * size + 0.5 * size, middles))


def _together(parts: Sequence[tuple[Array, Array]], orders: Array) -> Array:
    """Amplitude of one wave through all strokes at each of a few orders, each by one more than the last, (k,)."""
    total = np.zeros(orders.size, dtype=np.complex128)
    for x, e in parts:
        wave, on = np.exp(-1j * orders[0] * x) * e, np.exp(-1j * x)
        for i in range(orders.size):
            total[i] += wave.sum()
            wave *= on
    return np.abs(total)
