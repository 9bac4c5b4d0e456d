"""Steps where an encoder lost counts: each run has its own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key, Term, orthonormal
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.thresholds import STEP, STEP_AGAIN, STEP_ALIKE
from rig.model.effect import Array, Parameter, parameter
from rig.model.effects import EACH_RUN
from rig.model.effects.missed_counts import LOAD, MOTOR

LOST = EACH_RUN["missed_counts"]
WINDOW = 40  # rows before and after a step: a third of a second, shorter than the wander of an output
APART = 5.0  # usual steps between two rows: something was left out there
SEEN_ROUND = 0.5  # length of the mean of all angles as unit vectors: half a turn and more was seen
ONE_ANGLE = 4.6  # n·R² beyond which chance gets once in a hundred times, −ln 0.01
IN_THE_TORQUE = 0.5  # of a jump, which the torque sensor shows too
EDGE = 3  # rows over which the low-pass spreads a step


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
