"""Effects every run has in its own way: a vibration of unknown phase, steps where an encoder lost counts.

They are found in the fitted runs; where they are, each run, held out or not, is given its own phase or its own steps.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term, orthonormal
from rig.analysis.tracing.thresholds import LINE, LINE_RUNS, LINE_SPEEDS, STEP, STEP_AGAIN, STEP_ALIKE
from rig.model.effect import Array, Parameter, parameter
from rig.model.effects import EACH_RUN
from rig.model.effects.external_vibration import ExternalVibration
from rig.model.effects.missed_counts import LOAD, MOTOR

VIBRATION, LOST = EACH_RUN["external_vibration"], EACH_RUN["missed_counts"]
IN_SHORT = {name: effect.in_short for name, effect in EACH_RUN.items()}
ZOOM = 4  # finer than a run's own resolution
WINDOW = 40  # rows before and after a step: a third of a second, shorter than the wander of an output
APART = 5.0  # usual steps between two rows: something was left out there
SEEN_ROUND = 0.5  # length of the mean of all angles as unit vectors: half a turn and more was seen
ONE_ANGLE = 4.6  # n·R² beyond which chance gets once in a hundred times, −ln 0.01
IN_THE_TORQUE = 0.5  # of a jump, which the torque sensor shows too
EDGE = 3  # rows over which the low-pass spreads a step


@dataclass(frozen=True)
class Vibration:
    """A line at one frequency in runs of differing speed: amplitude by channel (median over runs), and half the 95 %
    intervals of the frequency [Hz] and of the torque [N·m]."""

    frequency_hz: float
    amplitude: dict[str, float]
    half_hz: float
    half_torque: float

    def of_the_load(self, stiffness: float) -> bool:
        """True for a torque on the load; an interference in the torque sensor would wind the gear up in A too."""
        torque = self.amplitude.get("L", 0.0)
        return torque > 0 and self.amplitude.get("A", 0.0) < 0.5 * torque / stiffness

    def parameters(self) -> tuple[Parameter, ...]:
        """Frequency and amplitude."""
        return (
            parameter("frequency", self.frequency_hz, self.half_hz, "Hz"),
            parameter("torque_amplitude", self.amplitude.get("L", 0.0), self.half_torque, "N·m"),
        )


@dataclass(frozen=True)
class Steps:
    """Rows of A where a run jumps, by how much [rad], and the encoder that lost the counts (`missed_counts.LOAD` …)."""

    rows: dict[int, tuple[int, ...]]
    sizes: dict[int, tuple[float, ...]]
    side: float = LOAD

    def parameters(self) -> tuple[Parameter, ...]:
        """Number of steps and their usual size at the output."""
        sizes = np.abs(np.concatenate([np.array(s) for s in self.sizes.values()]))
        half = 1.96 * float(np.std(sizes)) / np.sqrt(sizes.size)
        return (
            parameter("steps", float(sizes.size), 0.0, "1"),
            parameter(f"step_theta_{'m' if self.side == MOTOR else 'l'}", float(np.median(sizes)), half, "rad"),
        )


def clock(eq: Equations, key: Key) -> Array:
    """Time of each row, s."""
    run = eq.runs[key[0]]
    return np.asarray(np.concatenate([p.t[run.smoother.centres(p.t.size)] for p in run.pieces])[eq.rows[key].keep])


def find_vibration(eq: Equations, e: Mapping[Key, Array]) -> Vibration | None:
    """The strongest line at a fixed frequency in L (in A without a torque sensor), None when there is none."""
    channel = "L" if any(c == "L" for _, c in e) else "A"
    keys = [k for k in e if k[1] == channel and e[k].size > 256]
    if len(keys) < 3:
        return None
    top = min(0.5 / (eq.runs[k[0]].smoother.dt * eq.runs[k[0]].smoother.step) for k in keys)
    grid = np.arange(ExternalVibration.LOWEST, 0.98 * top, ExternalVibration.STEP)
    heights = np.array([_heights(clock(eq, k), e[k], grid) for k in keys])
    speed = np.array([eq.runs[k[0]].turning for k in keys])
    hits = heights > LINE
    score = np.where(hits.mean(0) > LINE_RUNS, np.median(heights, axis=0), 0.0)
    for at in np.argsort(-score)[:50]:
        if score[at] <= 0:
            return None
        hit = speed[hits[:, at]]
        if hit.max() > LINE_SPEEDS * hit.min():
            return _vibration(eq, e, keys, _sharpened(eq, e, keys, float(grid[at])))
    return None


def _heights(t: Array, e: Array, grid: Array) -> Array:
    """Power at `grid` Hz over what is usual around it."""
    dt = float(np.median(np.diff(t)))
    even = np.zeros(round((t[-1] - t[0]) / dt) + 1)
    even[np.minimum(np.round((t - t[0]) / dt).astype(int), even.size - 1)] = e
    n = ZOOM * even.size
    power = np.abs(np.fft.rfft(even * np.hanning(even.size), n)) ** 2
    hz = np.fft.rfftfreq(n, dt)
    width = max(1, int(1.5 / hz[1]))  # Hz on each side make the background
    coarse = power[: power.size // width * width].reshape(-1, width)
    usual = np.interp(np.arange(power.size), (np.arange(len(coarse)) + 0.5) * width, np.median(coarse, axis=1))
    reach = max(1, round(0.02 / hz[1]))
    best = power.copy()
    for shift in range(1, reach + 1):
        best[shift:] = np.maximum(best[shift:], power[:-shift])
        best[:-shift] = np.maximum(best[:-shift], power[shift:])
    return np.asarray(np.interp(grid, hz, best / np.maximum(usual, 1e-300)))


def _sharpened(eq: Equations, e: Mapping[Key, Array], keys: Sequence[Key], about: float) -> float:
    """The frequency that takes most from all runs together, each with its own phase."""
    best = about
    # 0.002 Hz first, then a tenth of a turn in the longest run
    for half in (0.06, 0.003):
        fine = best + np.linspace(-half, half, 61)
        total = np.zeros(fine.size)
        for key in keys:
            t = clock(eq, key)
            wave = np.exp(-2j * np.pi * np.multiply.outer(fine, t - t.mean()))
            total += np.abs(wave @ e[key]) ** 2 / e[key].size
        best = float(fine[int(np.argmax(total))])
    return best


def _vibration(eq: Equations, e: Mapping[Key, Array], keys: Sequence[Key], frequency: float) -> Vibration:
    """Amplitudes and intervals at that frequency."""
    columns = vibration_columns(eq, frequency)
    sizes = {key: _size(e[key], columns[key], eq.rows[key].z) for key in keys if key in columns}
    amplitude = _amplitudes(eq, e, frequency) | ({"L": float(np.median([*sizes.values()]))} if sizes else {})
    spread = float(np.std([*sizes.values()])) / np.sqrt(max(1, len(sizes))) if sizes else 0.0
    information = 0.0
    for key in keys:
        t, n = clock(eq, key), e[key].size
        x = 2 * np.pi * frequency * t
        wave = _size(e[key], np.stack([np.cos(x), np.sin(x)], 1), np.ones((n, 1)))
        noise = max(float(np.var(e[key])) - wave**2 / 2, 1e-300) * eq.noise.kappa[key[1]]
        information += wave**2 * n * (t[-1] - t[0]) ** 2 / (24 * noise)  # of 2π·f, one run      [rife1974]
    return Vibration(frequency, amplitude, 1.96 / (2 * np.pi * np.sqrt(max(information, 1e-300))), 1.96 * spread)


def _size(e: Array, columns: Array, beside: Array) -> float:
    """Amplitude of the wave that two columns make of a residual, beside what the baseline makes of the same wave: an
    inertia that was fitted without the vibration is off."""
    z = np.hstack([columns, beside / np.maximum(np.abs(beside).max(0), 1e-300)])
    return float(np.hypot(*np.linalg.lstsq(z, e, rcond=None)[0][:2]))


def _amplitudes(eq: Equations, e: Mapping[Key, Array], frequency: float) -> dict[str, float]:
    """Median over runs, by channel, in its unit, with what the low-pass takes put back."""
    out = {}
    for channel in "AML":
        sizes = []
        for key in (k for k in e if k[1] == channel):
            t = clock(eq, key)
            sizes.append(2 * abs(np.exp(-2j * np.pi * frequency * t) @ e[key]) / e[key].size)
        if sizes:
            sigma = eq.runs[0].smoother.sigma_hz
            out[channel] = float(np.median(sizes)) * float(np.exp(0.5 * (frequency / sigma) ** 2))
    return out


def vibration_columns(eq: Equations, frequency: float) -> dict[Key, Array]:
    """Cosine and sine in every block in which a torque on the load shows, (n, 2)."""
    runs = sorted({i for i, _ in eq.rows})
    made = {i: eq.term(i, Term(VIBRATION, (frequency,))) for i in runs}
    return {(i, c): m for i in runs for c, m in made[i].items() if np.any(m)}


def find_steps(eq: Equations, e: Mapping[Key, Array], compliance: float = 0.0) -> Steps:
    """Sharp permanent jumps of A in each run of `e`, but for those the torque sensor shows as well: a torque that comes
    and goes winds the gear of `compliance` [rad/(N·m)] up, or seems to."""
    keys = [k for k in e if k[1] == "A"]
    onward = {key: _onward(eq, key) for key in keys}
    sure = [abs(size) for key in keys for _, size in _jumps(e[key], onward[key], STEP, (0.0, np.inf))]
    # once it is known how many counts are lost at a time, smaller evidence of the same loss will do
    usual = float(np.median(sure)) if sure else 0.0
    rows: dict[int, tuple[int, ...]] = {}
    sizes: dict[int, tuple[float, ...]] = {}
    for key in keys if sure else []:
        found = _jumps(e[key], onward[key], STEP_AGAIN, (0.65 * usual, max(1.35 * usual, 1.1 * max(sure))))
        found = [(at, size) for at, size in found if not _of_the_torque(eq, e, key, at, size, compliance)]
        if found:
            rows[key[0]] = tuple(at for at, _ in found)
            sizes[key[0]] = tuple(size for _, size in found)
    return Steps(rows, sizes, side_of(eq, e, rows))


def _of_the_torque(eq: Equations, e: Mapping[Key, Array], key: Key, row: int, size: float, compliance: float) -> bool:
    """Whether the torque jumps to stay with the angle. Lost counts seem to accelerate the load for a moment alone."""
    other = (key[0], "L")
    if compliance <= 0 or other not in e:
        return False
    at = int(np.searchsorted(clock(eq, other), clock(eq, key)[row]))
    before, after = e[other][max(0, at - EDGE - WINDOW) : max(0, at - EDGE)], e[other][at + EDGE : at + EDGE + WINDOW]
    if min(before.size, after.size) < WINDOW // 2:
        return False
    return abs(float(after.mean() - before.mean())) * compliance > IN_THE_TORQUE * abs(size)


def side_of(eq: Equations, e: Mapping[Key, Array], rows: Mapping[int, Sequence[int]]) -> float:
    """The encoder whose torque channel jerks at the jumps: a reading that jumps seems to accelerate its inertia."""
    gone = dict.fromkeys((LOAD, MOTOR), 0.0)
    for side, channel in ((LOAD, "L"), (MOTOR, "M")):
        for run, at in rows.items():
            made = _columns(eq, run, at, side).get(channel)
            if made is not None and (run, channel) in e and np.any(made):
                basis = orthonormal(eq.without_offset((run, channel), made))
                gone[side] += float(np.sum((basis.T @ e[run, channel]) ** 2)) * eq.noise.weight(channel)
    return max(gone, key=lambda side: gone[side])


def _columns(eq: Equations, run: int, rows: Sequence[int], side: float) -> dict[str, Array]:
    """One column a jump in each channel of a run, (n, jumps)."""
    t = clock(eq, (run, "A"))
    made = [eq.term(run, Term(LOST, (side, 0.5 * (t[at] + t[max(at - 1, 0)])))) for at in rows]
    return {c: np.hstack([m[c] for m in made]) for c in made[0]} if made else {}


def _onward(eq: Equations, key: Key) -> Array:
    """True for rows with a window on both sides in which the motor neither turned back nor was left out, (n,).

    At a reversal everything with memory or play goes over to its other branch: that looks like a step and is none.
    """
    way = np.sign(np.diff(eq.rows[key].theta_m, prepend=eq.rows[key].theta_m[0]))
    t = clock(eq, key)
    gap = np.diff(t, prepend=t[0]) > APART * float(np.median(np.diff(t)))
    turned = np.concatenate([[0], np.cumsum(np.abs(np.diff(_filled(way))) > 0) + np.cumsum(gap[1:])])
    reach = WINDOW + EDGE
    first, last = np.maximum(np.arange(t.size) - reach, 0), np.minimum(np.arange(t.size) + reach, t.size - 1)
    return np.asarray(turned[first] == turned[last])


def _filled(way: Array) -> Array:
    """Zeros replaced by the way before them: two rows on one count are no turning back."""
    at = np.maximum.accumulate(np.where(way != 0, np.arange(way.size), 0))
    return np.asarray(way[at])


def _jumps(e: Array, onward: Array, least: float, between: tuple[float, float]) -> list[tuple[int, float]]:
    """Row and size of every jump: the means of the windows on both sides differ, and nearly all of it at once.

    `least` in usual differences of such windows, size `between` two bounds [rad]; only where the motor goes `onward`.
    """
    if e.size < 6 * WINDOW:
        return []
    total = np.concatenate([[0.0], np.cumsum(e)])
    at = np.arange(WINDOW + EDGE, e.size - WINDOW - EDGE)
    after = (total[at + EDGE + WINDOW] - total[at + EDGE]) / WINDOW
    before = (total[at - EDGE] - total[at - EDGE - WINDOW]) / WINDOW
    jump = after - before
    usual = float(np.median(np.abs(jump))) / 0.6745
    out: list[tuple[int, float]] = []
    strength = np.abs(jump) / max(usual, 1e-300)
    while strength.size and strength.max() > least:
        top = int(np.argmax(strength))
        row = int(at[top])
        near = e[row + EDGE : row + 4 * EDGE].mean() - e[row - 4 * EDGE : row - EDGE].mean()
        sharp = abs(near - jump[top]) < 0.5 * abs(jump[top])
        if sharp and onward[row] and between[0] <= abs(jump[top]) <= between[1]:
            out.append((row, float(jump[top])))
        strength[max(0, top - WINDOW) : top + WINDOW] = 0.0
    return out


def lost_counts(eq: Equations, steps: Steps, pairs: Sequence[tuple[int, int]]) -> bool:
    """Whether the jumps are lost counts: there are some, and repeats do not jump at the same angle as a tooth would,
    nor all runs at one angle of a shaft as a scale with a fault would."""
    count = sum(len(r) for r in steps.rows.values())
    if count == 0 or any(_at_one_angle(eq, steps, per_turn) for per_turn in (1.0, eq.runs[0].ratio)):
        return False
    same = 0
    for a, b in pairs:
        x, y = (eq.rows[i, "A"].theta_m[list(steps.rows.get(i, ()))] for i in (a, b))
        same += int(sum(np.min(np.abs(y - v)) < STEP_ALIKE for v in x)) if y.size else 0
    return same * 4 < count


def _at_one_angle(eq: Equations, steps: Steps, per_turn: float) -> bool:
    """Whether the jumps lie nearer together on a shaft that turns once in `per_turn` turns of the motor than chance
    does once in a hundred times (Rayleigh's test), and not because the runs saw no more of that shaft."""
    thetas = [eq.rows[run, "A"].theta_m for run in steps.rows]
    jumps = np.concatenate([theta[list(rows)] for theta, rows in zip(thetas, steps.rows.values(), strict=True)])
    seen, found = (float(abs(np.mean(np.exp(1j * x / per_turn)))) for x in (np.concatenate(thetas), jumps))
    return seen < SEEN_ROUND and jumps.size * found**2 > ONE_ANGLE


def step_columns(eq: Equations, steps: Steps) -> dict[Key, Array]:
    """One column a jump in every channel it shows in, (n, jumps)."""
    made = {run: _columns(eq, run, rows, steps.side) for run, rows in steps.rows.items()}
    return {(run, c): m for run, columns in made.items() for c, m in columns.items() if np.any(m)}


def explained(eq: Equations, e: Mapping[Key, Array], columns: Mapping[Key, Array]) -> float:
    """Share of the excess over the floor in A that columns of their own take, in the blocks of `e` that have some.
    What a step does to the torques is no measure: it has another unit, and is hardly seen there."""
    own = {key: orthonormal(eq.without_offset(key, x)) for key, x in columns.items() if key[1] == "A"}
    keys = [key for key in own if key in e]
    excess = sum(float(e[k] @ e[k]) - e[k].size * eq.noise.sigma[k[1]] ** 2 for k in keys)
    return sum(float(np.sum((own[k].T @ e[k]) ** 2)) for k in keys) / max(excess, 1e-300)


def joined(made: Sequence[Mapping[Key, Array]]) -> dict[Key, Array]:
    """Columns of all kinds side by side, (n, q)."""
    return {key: np.hstack([m[key] for m in made if key in m]) for key in {k for m in made for k in m}}
