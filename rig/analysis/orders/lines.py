"""Order spectra: lines per motor turn (or per output turn) over long spans, non-integer ones included."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rig.analysis.findings.intervals import RAYLEIGH95
from rig.analysis.findings.result import Array
from rig.analysis.orders.sums import BLOCK, fit, harmonics, without
from rig.core.units import TURN

FALSE_ALARM = 0.01  # probability that noise alone gives a single line anywhere in the spectrum
NEIGHBOURS = 24  # independent orders on either side from which the local noise is taken
MARGIN = 1.25  # the local noise is itself known to a quarter only
MOST_LINES = 24
WIDE_BLOCK = 4 * BLOCK  # where few columns share the cache
LINE_BINS = 4.0  # bins a period when searching: the amplitudes are fitted to the rows themselves afterwards


@dataclass(frozen=True)
class Line:
    """A_o·cos(o·θ − ψ): amplitude in the unit of the data, 1 σ of it, ψ rad, the span's resolution in orders."""

    order: float
    amplitude: float
    u: float
    phase: float
    u_phase: float
    resolution: float

    @property
    def resolved(self) -> bool:
        """Whether it stands above what noise alone reaches in 1 case of 20 at one given order."""
        return self.amplitude > RAYLEIGH95 * self.u


def resample(theta: Array, y: Array, per_turn: int) -> tuple[Array, Array]:
    """`y` (n,) averaged in `per_turn` equal bins a turn of the angle `theta` [rad, one direction]: (turns, values).

    All rows count: noise averages down within a bin. Empty bins are interpolated.
    """
    low, high = float(theta.min()) / TURN, float(theta.max()) / TURN
    bins = max(int((high - low) * per_turn), 1)
    # behind the last whole bin a part of one, and a row that rounding puts behind that
    rows, where, total = np.zeros(bins + 2), np.zeros(bins + 2), np.zeros(bins + 2)
    for start in range(0, theta.size, WIDE_BLOCK):  # whole arrays of a long run do not fit the cache: twice the time
        along = theta[start : start + WIDE_BLOCK] * (per_turn / TURN)
        along -= low * per_turn
        place = along.astype(np.int64)
        first, last = int(place.min()), int(place.max())  # one direction: few bins
        place -= first
        rows[first : last + 1] += np.bincount(place)
        where[first : last + 1] += np.bincount(place, along)
        total[first : last + 1] += np.bincount(place, y[start : start + WIDE_BLOCK])
    for sums in (rows, where, total):
        sums[bins - 1] += sums[bins:].sum()
    here = rows[:bins] > 0
    rows, where, total = (sums[:bins] if here.all() else sums[:bins][here] for sums in (rows, where, total))
    where /= rows
    total /= rows
    centre = np.arange(0.5, bins)
    values = _moved(centre, where, total) if here.all() and bins > 2 else np.interp(centre, where, total)
    centre /= per_turn
    centre += low
    return centre, values


def _moved(x: Array, known: Array, y: Array) -> Array:
    """`y` of `known` moved to `x`, each by less than to its neighbours, along the slope between these two."""
    out = np.empty_like(x)
    for start in range(0, x.size, WIDE_BLOCK):
        stop = min(start + WIDE_BLOCK, x.size)
        slope = _slope(known[max(start - 1, 0) : stop + 1], y[max(start - 1, 0) : stop + 1])
        slope = slope[min(start, 1) :][: stop - start]
        slope *= x[start:stop] - known[start:stop]
        out[start:stop] = slope
        out[start:stop] += y[start:stop]
    return out


def _slope(x: Array, y: Array) -> Array:
    """dy/dx of rows in order, from the neighbours on either side; at the ends from the one there is."""
    slope = np.empty_like(y)
    slope[1:-1] = y[2:] - y[:-2]
    slope[1:-1] /= x[2:] - x[:-2]
    slope[[0, -1]] = (y[[1, -1]] - y[[0, -2]]) / (x[[1, -1]] - x[[0, -2]])
    return slope


def bins_per_turn(rows_per_turn: float, order_max: float) -> int:
    """Bins for a spectrum up to `order_max`: eight a period if the rows allow, never more bins than rows."""
    return max(int(min(8.0 * order_max, rows_per_turn)), 2)


def spectrum(theta: Array, y: Array, order_max: float = 40.0) -> tuple[Array, Array]:
    """Amplitude spectrum of `y` over the angle `theta` [rad, one direction], Hann window, zero-padded twofold.

    Gives (orders, amplitudes); a sine of amplitude A shows A (its averaging within bins is undone). Resolution is two
    orders per span, 2/turns. Ends below `order_max` where the rows are too few.
    """
    turns, values = resample(theta, y, _bins(theta, order_max))
    n, step = values.size, float(turns[1] - turns[0]) if turns.size > 1 else 1.0
    window = np.hanning(n + 2)[1:-1]
    padded = 1 << int(np.ceil(np.log2(max(2 * n, 4))))
    amplitude = np.abs(np.fft.rfft((values - values.mean()) * window, padded)) * (2.0 / window.sum())
    orders = np.arange(amplitude.size) / (padded * step)
    keep = orders <= min(order_max, 0.4 / step)
    return orders[keep], amplitude[keep] / np.sinc(orders[keep] * step)


def _bins(theta: Array, order_max: float) -> int:
    span = max(abs(float(theta[-1] - theta[0])) / TURN, 1e-9)
    return bins_per_turn(theta.size / span, order_max)


def _sinusoids(turns: Array, orders: Array) -> Callable[[int, int], Array]:
    """Constant, cosines and sines of `orders` at the rows asked for; whole orders by products: much faster."""
    whole = (orders == np.round(orders)) & (orders >= 1) & (orders <= 64)
    most = int(orders[whole].max()) if whole.any() else 0
    index = orders[whole].astype(np.int64) - 1

    def columns(lo: int, hi: int) -> Array:
        """(1 + 2·orders, hi − lo): ones, cosines, sines at the rows `lo` to `hi`."""
        k = orders.size
        out = np.empty((1 + 2 * k, hi - lo))
        out[0] = 1.0
        angle = TURN * np.multiply.outer(orders[~whole], turns[lo:hi])
        out[1 : 1 + k][~whole], out[1 + k :][~whole] = np.cos(angle), np.sin(angle)
        if most:
            both = harmonics(TURN * turns[lo:hi], most)
            out[1 : 1 + k][whole], out[1 + k :][whole] = both[index], both[most + index]
        return out

    return columns


def _local_noise(step: float, rest: Array, order: float) -> float:
    """Variance of one coefficient (cosine or sine) at `order`, from the residual's periodogram on either side of it."""
    n = rest.size
    power = np.abs(np.fft.rfft(rest)) ** 2 * (2.0 / n) ** 2  # squared amplitudes at whole cycles per span
    away = np.abs(np.arange(power.size) - order * n * step)
    near = (away <= NEIGHBOURS) & (away >= 1.5)
    near[[0, -1]] = False
    if near.sum() < 3:
        return float(np.mean(rest**2) * 2.0 / n)
    return float(np.mean(power[near])) / 2.0


def fit_lines(theta: Array, y: Array, orders: list[float]) -> list[Line]:
    """Amplitude and phase of the given orders together, by least squares over the rows; 1 σ from the noise around each.

    `theta`: rad, one direction; `y`: any unit. Orders closer than 1/span cannot be told apart; their σ does not say so.
    """
    wanted, turns = np.asarray(orders, dtype=np.float64), theta / TURN
    zero = float(y.mean())
    columns = _sinusoids(turns, wanted)
    c = fit(columns, y - zero)
    rest = without(columns, y - zero, c)
    grid, values = resample(theta, rest, _bins(theta, 2.0 * float(wanted.max()) + 4.0))
    step = float(grid[1] - grid[0])
    lines = []
    for j, order in enumerate(orders):
        a, b = float(c[1 + j]), float(c[1 + wanted.size + j])
        u, amplitude = float(np.sqrt(_local_noise(step, values, order))), float(np.hypot(a, b))
        u_phase = u / amplitude if amplitude > 0 else float("inf")
        lines.append(Line(order, amplitude, u, float(np.arctan2(b, a)), u_phase, 1.0 / (grid.size * step)))
    return lines


def find_lines(
    theta: Array,
    y: Array,
    order_max: float,
    slowest: float = 0.0,
    known: tuple[float, ...] = (),
    false_alarm: float = FALSE_ALARM,
    most: int = MOST_LINES,
) -> list[Line]:
    """Lines that stand out of the local noise, strongest first.

    A periodogram of pure noise is exponential around its local mean, so the largest of M independent orders exceeds
    ln(M/α) times that mean with probability α; the mean is taken from the running median, which lines do not lift.
    The strongest line is refined, subtracted with all before it, and the search repeated. `known` orders are
    subtracted from the start and fitted with the rest, and only returned where they stand out too. Nothing below
    `slowest` is looked at: noise rises there, and a rise is easily taken for a line.
    """
    turns, values = resample(theta, y, _bins(theta, LINE_BINS / 8.0 * order_max))
    n, step = values.size, float(turns[1] - turns[0]) if turns.size > 1 else 1.0
    span = n * step
    independent = int(span * min(order_max, 0.4 / step))
    if independent < 8:
        return []
    window = np.hanning(n + 2)[1:-1]
    fine = np.arange(4 * independent) / (4.0 * span)  # four trial orders for every independent one
    found = [k for k in known if k < 0.4 / step]
    centred = turns - turns.mean()
    rest = values - values.mean()
    if found:
        rest = _clean(centred, rest, np.asarray(found))[0]
    most += len(found)
    while len(found) < most:
        ratio = _above_noise(rest * window, fine.size)
        ratio[fine < max(slowest, 1.5 / span)] = 0.0  # slower than that is trend
        for order in found:  # what is left this close is the same line, not quite steady
            ratio[np.abs(fine - order) < 1.5 / span] = 0.0
        best = int(np.argmax(ratio))
        if ratio[best] < MARGIN * np.log(fine.size / false_alarm):
            break
        _, shift = _clean(centred, rest, fine[best : best + 1])
        order = float(fine[best] + np.clip(shift[0], -0.5 / span, 0.5 / span))
        rest, shift = _clean(centred, rest, np.array([order]))
        found.append(order + float(np.clip(shift[0], -0.1 / span, 0.1 / span)))
    lines = fit_lines(theta, y, found) if found else []
    return sorted((line for line in lines if line.resolved), key=lambda line: -line.amplitude)


def _above_noise(values: Array, orders: int) -> Array:
    """Periodogram of `values` at the first `orders` quarters of a cycle per span, over its local mean."""
    power = np.abs(np.fft.rfft(values, 4 * values.size))[:orders] ** 2
    noise = np.repeat(_local_median(power[::4]), 4)[: power.size] / np.log(2.0)
    ratio: Array = power / np.maximum(noise, 1e-300)
    return ratio


def _clean(turns: Array, values: Array, orders: Array) -> tuple[Array, Array]:
    """`values` less lines whose amplitude and phase may change along the span, and how far each order was missed.

    Fits (a + c·x)·cos + (b + d·x)·sin, x centred: a line at order + δ has c = 2πδ·b and d = −2πδ·a, to first order.
    """
    plain, k, reach = _sinusoids(turns, orders), orders.size, float(np.abs(turns).max())

    def columns(lo: int, hi: int) -> Array:
        """(1 + 4·orders, hi − lo): those of `plain`, then its waves again, growing from −1 to 1 along the span."""
        steady = plain(lo, hi)
        return np.concatenate((steady, steady[1:] * (turns[lo:hi] / reach)))

    c = fit(columns, values)
    a, b, growth, turning = c[1 : k + 1], c[k + 1 : 2 * k + 1], c[2 * k + 1 : 3 * k + 1], c[3 * k + 1 :]
    shift = (growth * b - turning * a) / np.maximum(a**2 + b**2, 1e-300) / (TURN * reach)
    return without(columns, values, c), np.asarray(shift)


def _local_median(x: Array) -> Array:
    """Median of the neighbours of each value: a third of its own number, 8 to NEIGHBOURS on either side.

    Friction and drift make noise that falls with frequency: near zero only close neighbours have the same noise.
    """
    out = np.empty_like(x)
    wide, hold = 3 * NEIGHBOURS, NEIGHBOURS // 4  # held for a quarter of the half width: the noise varies slowly
    for i in range(0, min(wide, x.size), 2):
        half = min(max(i // 3, 8), NEIGHBOURS)
        out[i : i + 2] = np.median(x[max(i - half, 0) : i + half + 1])
    if x.size > wide:
        ends = np.pad(x, (0, 2 * NEIGHBOURS + 1), mode="reflect")
        views = np.lib.stride_tricks.sliding_window_view(ends[wide - NEIGHBOURS :], 2 * NEIGHBOURS + 1)[::hold]
        out[wide:] = np.repeat(np.median(views, axis=1), hold)[: x.size - wide]
    return out
