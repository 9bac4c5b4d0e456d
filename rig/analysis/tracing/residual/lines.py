"""Orders of an angle and frequencies of the clock that a rest may follow."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from rig.analysis.tracing.residual.binned import Halves, score
from rig.analysis.tracing.residual.coordinates import INDICES, both, steps, turned
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.readings import in_bins, in_columns, share, waves
from rig.core.units import TURN
from rig.model.effect import Array

LOWEST = 0.8  # Hz of a line; a slow run's motor turns every six seconds
FINEST = {"motor_angle": (0.001, 0.02), "load_angle": (0.02, 1.0)}  # orders apart: half a cycle over all the turns
SPAN = {
    "motor_angle": (0.3, 130.0),
    "load_angle": (0.9, 400.0),
}  # orders; a bearing's cage turns at 0.35 and more of its
# shaft, and what takes longer than a turn of the output is an angle gone
HALF = 0.5  # turns: in less, what does not come round once is a trend and has no order
AS_WELL = 0.98  # of its height the whole order beside it must have to be said instead
NEAR = 41  # orders tried beside the best one of the grid: to a fortieth of a cycle in all
SLOWEST = 1 / 12.0  # Hz of what comes and goes by the clock: some times in the shortest of runs
DAY = 40  # quarter waves of SLOWEST that a campaign must take: in two minutes a slow wave is a trend
ONE_SPEED = 0.2  # of it: what a triangle's turning points take from a mean
NEARLY_ALL = 0.8  # of the power
TOLD = 0.1  # of the motor's rate, what a run tells apart: a fifth of all frequencies is near a multiple by chance
STEP = 1 / (32 * LOWEST)  # s: a sixteenth of the shortest period
PHASES = 30  # of its period
OVERTONES = (1, 2, 3)
LOADS = 8  # levels of torque
SENSES: Sequence[Callable[[Rest], Array]] = (lambda r: np.ones(r.e.size), lambda r: r.at["direction"])
"""As it is, and as friction shows it: the other way round on the way back."""


BY_THE_CLOCK: Sequence[tuple[Callable[[Rest], Array], Callable[[Rest], Index]]] = (
    (SENSES[0], lambda r: np.ones(r.e.size, dtype=int)),
    (SENSES[1], INDICES["direction"]),
    (lambda r: np.nan_to_num(r.at["load"]), lambda r: steps(r.at["load"], LOADS)),
)
"""The same for what comes and goes by the clock, and what does so as a sensor's gain under load does."""


def best_order(h: Halves, name: str, channel: str, sense: Callable[[Rest], Array]) -> Home | None:
    """One harmonic of an angle, order free, against the `sense` of the motion: its share on the other fold. With its
    overtones, or in any form that comes back with it, where that does better: a scale that is stitched is a sawtooth, a
    dent in a race is a sharp one."""
    r = h.rest
    x = r.at[name]
    good = np.isfinite(x)
    if not good.any():
        return None
    x, e = x[good], (r.e * r.worth * sense(r))[good]
    if not e.any():
        return None
    turns = float(np.ptp(x)) / TURN
    step = float(np.clip(0.5 / max(turns, 1.0), *FINEST[name]))
    first = max(SPAN[name][0], step, 1 / turns if 0 < turns < HALF else 0.0)
    rough = np.arange(first, max(min(SPAN[name][1], highest(r, r.at[name])), first + 2 * step), step)
    power = spectrum(x, e, rough)
    fine = _sharpened(x, e, float(rough[int(np.argmax(power))]), step)
    near = np.array([fine, max(round(fine), 1)])
    k = float(near[1] if np.divide(*_height(x, e, near)) < 1 / AS_WELL else fine)
    read = in_columns(lambda rest: waves(rest.at[name], k) * sense(rest)[:, None])
    wave = Home(name, channel, share(h, read), order=k, read=read)
    richer = in_columns(lambda rest: np.hstack([waves(rest.at[name], n * k) for n in OVERTONES]) * sense(rest)[:, None])
    with_overtones = Home(name, channel, share(h, richer), order=k, read=richer)

    def phase(rest: Rest) -> Index:
        return both(turned(k * rest.at[name], PHASES), (sense(rest) + 1).astype(int))

    any_form = Home(name, channel, score(h, phase(r)) / h.total, order=k, read=in_bins(phase))
    return max(wave, with_overtones, any_form, key=lambda home: home.share)


def highest(r: Rest, x: Array) -> float:
    """Order of the angle `x` (n,) beyond which the rows of all runs are more than half a period apart: there a drift
    looks like a line."""
    apart = [float(np.median(np.abs(np.diff(x[r.run == run])))) for run in np.unique(r.run) if (r.run == run).sum() > 1]
    finest = min((step for step in apart if step > 0), default=0.0) / r.every
    return TURN / 2 / finest if finest > 0 else float("inf")


def _sharpened(x: Array, e: Array, order: float, step: float) -> float:
    """The order of a line that is known to one step of a grid, whose phase would be lost over all the turns."""
    near = order + step * np.linspace(-1.0, 1.0, NEAR)
    wave, on = np.exp(-1j * near[0] * x) * e, np.exp(-1j * (near[1] - near[0]) * x)
    height = np.zeros(NEAR)
    for i in range(NEAR):  # from one order to the next every row turns on by the same
        height[i] = abs(wave.sum())
        wave *= on
    return float(near[int(np.argmax(height))])


def _height(x: Array, e: Array, orders: Array) -> Array:
    """Of a line at each of a few orders, (orders,)."""
    return np.abs([np.exp(-1j * k * x) @ e for k in orders])


def spectrum(x: Array, e: Array, orders: Array) -> Array:
    """|Σ e·exp(−i·k·x)|² for orders on a uniform grid, rows counted into fine bins of x first; (orders,)."""
    step = float(orders[1] - orders[0])
    period = TURN / step
    size = 2 ** int(np.ceil(np.log2(4 * orders[-1] / step)))
    binned = np.bincount((np.mod(x, period) / period * size).astype(int) % size, e, minlength=size)
    lines = np.abs(np.fft.rfft(binned)) ** 2
    return np.asarray(lines[np.round(orders / step).astype(int)])


def line(r: Rest, channel: str) -> Home | None:
    """A frequency that stands out in runs of differing speed; what is slower comes and goes with the motion."""
    hits: dict[int, list[tuple[float, float, float]]] = {}
    for run in np.unique(r.run):
        e, mine = r.e[r.run == run], r.run == run
        if e.size < 512:
            continue
        power = np.abs(np.fft.rfft(e * np.hanning(e.size))) ** 2
        hz = np.fft.rfftfreq(e.size, r.dt)
        slow = max(3, int(np.searchsorted(hz, LOWEST)))
        top = int(np.argmax(power[slow:])) + slow
        speed = float(np.mean(np.abs(r.at["speed"][mine])))
        near = slice(max(0, top - 3), top + 4)
        hits.setdefault(round(hz[top] * 5), []).append((hz[top], speed, float(power[near].sum() / power.sum())))
    best = max(hits.values(), key=len, default=[])
    speeds = np.array([s for _, s, _ in best])
    if len(best) < 3 or speeds.max() < 1.5 * speeds.min():
        return None
    part = float(np.mean([s for _, _, s in best])) * len(best) / max(1, np.unique(r.run).size)
    return Home("time_periodic", channel, part, frequency_hz=float(np.median([f for f, _, _ in best])))


def by_the_clock(
    h: Halves, channel: str, sense: Callable[[Rest], Array], among: Callable[[Rest], Index]
) -> Home | None:
    """What comes and goes with the time, of any form that all runs share: a pump, a brake that rubs against the
    `sense` of the motion, or what breathes under load and is as large as that: apart `among` what it depends on. Every
    run has a phase of its own, as clocks that are read to the second leave it. None where it is in runs of one speed
    alone, and comes as often as their motor goes round: then nothing tells it from a place on the motor.
    """
    r = h.rest
    t, e = r.at["time"], r.e * r.worth * sense(r)
    size = int(4 * longest(r) / STEP)  # to a quarter of what the longest run can tell apart
    hz = np.fft.rfftfreq(size, STEP)
    runs = np.unique(r.run)
    power = np.stack([np.abs(np.fft.rfft(_stepped(t[r.run == run], e[r.run == run]), size)) ** 2 for run in runs])
    place = int(np.argmax(np.where((hz >= SLOWEST) & (hz < 2 * LOWEST), power.sum(0), 0.0)))
    f = float(hz[place])
    speeds = np.array([float(np.mean(np.abs(r.at["speed"][r.run == run]))) for run in runs])
    if _as_the_motor_turns(f, speeds, power[:, place], 1 / longest(r)):
        return None

    def phase(rest: Rest) -> Index:
        own, signed = np.zeros(rest.e.size), rest.e * rest.worth * sense(rest)
        for run in np.unique(rest.run):
            mine = rest.run == run
            own[mine] = _phase(rest.at["time"][mine], signed[mine], f)
        return both(turned(TURN * f * rest.at["time"] + own, PHASES), among(rest))

    return Home("time_periodic", channel, score(h, phase(r)) / h.total, frequency_hz=f, read=in_bins(phase))


def _as_the_motor_turns(f: float, speeds: Array, power: Array, apart: float) -> bool:
    """Whether `f`, Hz, is a whole number of times the rate at which the motor turns, but for `apart` Hz, in those runs
    that have nearly all `power`, (runs,), of it; `speeds` rad/s, (runs,)."""
    loudest = float(speeds[int(np.argmax(power))])
    alike = np.abs(speeds - loudest) < ONE_SPEED * loudest
    if loudest <= 0 or power[alike].sum() < NEARLY_ALL * power.sum():
        return False
    rate = loudest / TURN
    if apart > TOLD * rate:  # any frequency is near one of its multiples: that says nothing
        return False
    return abs(f - max(round(f / rate), 1) * rate) < apart


def by_the_day(h: Halves, channel: str, sense: Callable[[Rest], Array]) -> Home | None:
    """A wave of the campaign's own time against the `sense` of the motion, slower than a run shows by itself: a room
    that warms and cools, and the friction in it."""
    r = h.rest
    x = TURN * r.at["time"]
    step = 0.25 * TURN / float(np.ptp(x))
    rough = np.arange(step, SLOWEST, step)
    if rough.size < DAY:
        return None
    e = r.e * r.worth * sense(r)
    f = _sharpened(x, e, float(rough[int(np.argmax(spectrum(x, e, rough)))]), step)
    read = in_columns(lambda rest: waves(TURN * rest.at["time"], f) * sense(rest)[:, None])
    return Home("time_periodic", channel, share(h, read), frequency_hz=f, read=read, late=True)


def _stepped(t: Array, e: Array) -> Array:
    """Mean of the rows of one run in each step of time, about their mean; 0 where there are none."""
    place = ((t - t[0]) / STEP).astype(int)
    count = np.bincount(place)
    mean = np.bincount(place, e) / np.maximum(count, 1)
    return np.where(count > 0, mean - mean[count > 0].mean(), 0.0)


def _phase(t: Array, e: Array, f: float) -> float:
    """Of the wave of `f` Hz in one run, rad at time 0."""
    mean = _stepped(t, e)
    at = t[0] + STEP * (np.arange(mean.size) + 0.5)
    return float(np.angle(np.exp(-1j * TURN * f * at) @ mean))


def longest(r: Rest) -> float:
    """Of the runs, s."""
    return max(float(np.ptp(r.at["time"][r.run == run])) for run in np.unique(r.run)) + r.dt
