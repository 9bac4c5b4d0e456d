"""What comes and goes with the clock within every run, too fast to be seen from run to run: a pump, a seal that rubs.

Each run has its own phase, so repeats differ by it and the floor holds it. It is told from an order of a shaft by its
phase, which no angle holds together, and by runs of other speeds, which show it too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key, orthonormal
from rig.analysis.tracing.floor.interference import around, even_grid
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.vibration import sharpened
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.readings import waves
from rig.analysis.tracing.thresholds import LINE, LINE_FREE, LINE_RUNS, LINE_SPEEDS, LOUD_LINE
from rig.core.units import TURN
from rig.model.effect import Array

TIMES: Final = 6.0  # periods a run must hold to tell a line from drift
FASTEST: Final = 0.8  # of half the row rate: there the low-pass leaves nothing
GRID: Final = 0.01  # Hz: what the longest runs resolve
FEWEST: Final = 3  # runs
PADDED: Final = 4  # finer than a run's own resolution
CLOCKED: Final = 4.0  # times the power by the angle with one phase for all: what follows the angle has less than once
SEEN: Final = 4.0  # power over its surroundings, mean of runs at other speeds: chance gives half of that
HARMONICS: Final = 3  # of its frequency: what rubs for half of the time has as many
TWICE: Final = 2.0  # periods in a run that is to be made of it
MADE_OF_IT: Final = 0.3  # of the power of runs at other speeds; of one that noise alone makes it takes a tenth
FINER: Final = 40  # orders tried on each side, a quarter of what a run resolves apart

Spectrum = tuple[float, float, Array, Array]
"""Lowest and highest Hz that a run can tell, its frequencies Hz (n,), and the power there over what is around (n,)."""
Sense = Callable[[Array], Array]
"""From motor angle (n,) to the sign with which the rest is taken, (n,)."""
SENSES: Final[Sequence[Sense]] = (lambda angle: np.ones(angle.size), lambda angle: np.sign(np.gradient(angle)))


def ticking(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], channels: Sequence[str] = WHOLE
) -> Home | None:
    """The loudest such line of the fitted residuals, with its share of the unseen ones; None where there is none, or
    no time."""
    if not eq.timed:
        return None
    return largest(home for channel in channels for home in _in_channel(eq, fitted, unseen, channel))


def largest(found: Iterable[Home | None]) -> Home | None:
    """The one with the largest share."""
    return max((home for home in found if home is not None), key=lambda home: home.share, default=None)


def _in_channel(eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], channel: str) -> list[Home]:
    mine = {k: e for k, e in fitted.items() if _tells(eq, k, channel, e)}
    spectra: dict[Key, Spectrum] = {}
    out = []
    for sense in SENSES:
        signs = {k: sense(eq.rows[k].theta_m) for k in mine}
        signed = {k: e * signs[k] for k, e in mine.items()}
        one_way = {k for k in spectra if abs(signs[k].sum()) == signs[k].size}  # which changes no power
        spectra = {k: spectra[k] if k in one_way else _spectrum(eq, k, x) for k, x in signed.items()}
        hz = _loudest(eq, signed, spectra)
        if hz is None or not _of_the_clock(eq, signed, spectra, hz):
            continue
        part = min(_share(eq, e, channel, sense, hz) for e in (fitted, unseen))
        if part > LOUD_LINE:
            out.append(Home("time_periodic", channel, part, frequency_hz=hz))
    return out


def _tells(eq: Equations, key: Key, channel: str, e: Array) -> bool:
    return key[1] == channel and not eq.runs[key[0]].locked and e.size > 256


def _loudest(eq: Equations, e: Mapping[Key, Array], spectra: Mapping[Key, Spectrum]) -> float | None:
    """Hz of the line that stands out in most of the runs that are long enough for it."""
    runs = [*spectra.values()]
    if len(runs) < FEWEST:
        return None
    grid = np.arange(min(low for low, _, _, _ in runs), min(high for _, high, _, _ in runs), GRID)
    able = np.array([grid >= low for low, _, _, _ in runs])
    heights = np.array([np.interp(grid, hz, over) for _, _, hz, over in runs])
    count = able.sum(0)
    often = ((heights > LINE) & able).sum(0) > LINE_RUNS * count
    usual = np.nanmedian(np.where(able, heights, np.nan), axis=0)
    score = np.where(often & (count >= FEWEST), usual, 0.0)
    top = int(np.argmax(score))
    return sharpened(eq, e, [*e], float(grid[top])) if score[top] > 0 else None


def _spectrum(eq: Equations, key: Key, e: Array) -> Spectrum:
    """Lowest and highest frequency that a run can tell, its frequencies, and its power there over what is usual around
    each, the largest within half of what it resolves."""
    even, dt, _ = even_grid(eq, key, e - e.mean())
    length = (even.size - 1) * dt
    power = np.abs(np.fft.rfft(even * np.hanning(even.size), PADDED * even.size)) ** 2
    hz = np.asarray(np.fft.rfftfreq(PADDED * even.size, dt))
    low, high = TIMES / length, FASTEST * 0.5 / dt
    band = (hz > 0.5 * low) & (hz < high)
    over = power[band] / np.maximum(around(power[None, :], hz, hz[band], 2 / length)[0], 1e-300)
    near = [np.roll(over, by) for by in range(-PADDED // 2, PADDED // 2 + 1)]
    return low, high, hz[band], np.max(near, axis=0)


def _of_the_clock(eq: Equations, e: Mapping[Key, Array], spectra: Mapping[Key, Spectrum], hz: float) -> bool:
    """Whether the line follows the clock and no angle: it stands out at speeds far apart; or, where most runs turn at
    one speed, it does not add up over the motor's angle with one phase for all, and the others show it faintly, or are
    made of it where they are too short to show a line."""
    speeds = {key: eq.runs[key[0]].turning for key in e}
    heights = {key: _height(spectrum, hz) for key, spectrum in spectra.items()}
    plain = [speed for key, speed in speeds.items() if heights[key] > LINE]
    if not plain:
        return False
    usual = float(np.median(plain))
    others = [key for key, speed in speeds.items() if not usual / LINE_SPEEDS < speed < usual * LINE_SPEEDS]
    if sum(speed > LINE_FREE * min(plain) for speed in plain) >= FEWEST:
        return True
    shares = [share for key in others if (share := _part(eq, key, e[key], hz)) is not None]
    made_of_it = len(shares) >= FEWEST and float(np.median(shares)) > MADE_OF_IT
    if not made_of_it and (not others or float(np.mean([heights[key] for key in others])) < SEEN):
        return False
    alike = [key for key in e if key not in others]
    if not alike:  # the median lies between two groups of runs, and tells of neither
        return False
    rows = sum(e[key].size for key in alike)
    by_time = sum(float(np.abs(np.exp(-1j * TURN * hz * clock(eq, key)) @ e[key]) ** 2) / e[key].size for key in alike)
    angles = [eq.rows[key].theta_m for key in alike]
    order, step = TURN * hz / max(usual, 1e-9), 0.25 * TURN / max(float(max(np.ptp(x) for x in angles)), 1e-9)
    orders = order + step * np.arange(-FINER, FINER + 1)
    waved = (np.exp(-1j * np.multiply.outer(orders, x)) @ e[key] for key, x in zip(alike, angles, strict=True))
    by_angle = float(np.max(np.abs(sum(waved, np.zeros(orders.size, complex))) ** 2)) / rows
    return by_time > CLOCKED * by_angle


def _part(eq: Equations, key: Key, e: Array, hz: float) -> float | None:
    """Of the sum of squares of one run about its mean, what a wave of that frequency takes; None where the run holds
    fewer than two, which a drift is as good as."""
    t = clock(eq, key)
    if float(np.ptp(t)) * hz < TWICE:
        return None
    columns = orthonormal(eq.without_offset(key, waves(TURN * t, hz)))
    return float(np.sum((columns.T @ e) ** 2)) / max(float(np.sum((e - e.mean()) ** 2)), 1e-300)


def _height(spectrum: Spectrum, hz: float) -> float:
    """Of one run at a frequency; 1 where it is too short for it."""
    low, high, at, over = spectrum
    return float(np.interp(hz, at, over)) if 0.5 * low < hz < high else 1.0


def _share(eq: Equations, e: Mapping[Key, Array], channel: str, sense: Sense, hz: float) -> float:
    """Of the sum of squares of a channel, what the line and its harmonics take with a phase of each run's own, less
    what noise gives them by chance."""
    gone = total = 0.0
    for key, x in e.items():
        if not _tells(eq, key, channel, x):
            continue
        columns = np.hstack([waves(TURN * clock(eq, key), k * hz) for k in range(1, HARMONICS + 1)])
        basis = orthonormal(eq.without_offset(key, columns * sense(eq.rows[key].theta_m)[:, None]))
        chance = basis.shape[1] * eq.noise.kappa[channel] * float(np.mean(x**2))
        gone += float(np.sum((basis.T @ x) ** 2)) - chance
        total += float(x @ x)
    return gone / max(total, 1e-300)
