"""A reading that is late by another time in every run: acquisition that starts anew, a buffer that fills as it likes.

Repeats then differ by their speed times what their delays differ by, so that it is in the floor. Zeros, friction and a
spring that are not the same twice make repeats differ as well, but not in proportion to the speed: which of these it is
the repeats are asked, each by its evidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Key, Term, less, orthonormal
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.floor.local import at_rows, clock
from rig.analysis.tracing.runs.alike import repeats
from rig.core.quantiles import Z95
from rig.model.effect import Array, Parameter, parameter
from rig.model.effects import CATALOGUE
from rig.model.effects.channel_time_skew import ALONG_RUN, KNOTS, LOAD, STEADY, along

SKEW: Final = CATALOGUE["channel_time_skew"]
CURVE: Final = Term(SKEW, (LOAD, 0.0, ALONG_RUN))
ONE: Final = Term(SKEW, (LOAD, 0.0, STEADY))
TOGETHER: Final = 8  # rows, a mean of which is taken for independent of the next
FEWEST: Final = 4  # pairs of repeats
SHORTEST: Final = 3  # means of rows a number of two curves, at least: of fewer their noise is not known
DIFFER: Final = 500.0  # nats by which repeats differ, the most unlike pair left out: of clean campaigns by 120 at most
BEYOND: Final = 10.0  # nats over what else may differ from run to run: once in 20 000
SIZES: Final = np.geomspace(0.03, 30.0, 13)  # times what the repeats differ by at a glance
ALIKE: Final = (0.5, 0.99)  # correlation of a curve's values: one that wanders, one that is the same all along a run
FAST: Final = 0.2  # of the highest speed: below it a run tells little of its delay


@dataclass(frozen=True)
class OwnDelays:
    """Columns (n, k) of every run, its delays [s] by run, (k,), and whether they wander within runs."""

    columns: dict[Key, Array]
    delays: dict[int, Array]
    wander: bool

    def parameters(self) -> tuple[Parameter, ...]:
        """Their mean over runs, and how they scatter about it."""
        mean = np.array([x.mean() for x in self.delays.values()])
        every = np.concatenate([*self.delays.values()])
        scatter = float(every.std())
        return (
            parameter("skew_theta_l", float(mean.mean()), Z95 * float(mean.std(ddof=1)) / np.sqrt(mean.size), "s"),
            parameter("scatter_theta_l", scatter, Z95 * scatter / np.sqrt(2 * mean.size), "s"),
        )

    def sentence(self) -> str:
        """What differs, and what is not told."""
        how = "and wanders within runs" if self.wander else "and the same all along each"
        return (
            f"The delay of one angle behind the other is another one in every run, {how}: repeats differ in proportion "
            "to the speed. Each run was given its own. Which of the two encoders is late they do not tell."
        )


@dataclass(frozen=True)
class _Pair:
    """How two repeats differ, (n,), its variance by noise [rad²], and columns (n, 2k) by what may make it: those of the
    one and those of the other. All without what both share."""

    y: Array
    noise: float
    made: dict[str, Array]


def own_delays(s: Solution, whole: Sequence[int], runs: Sequence[int]) -> OwnDelays | None:
    """By the repeats among runs `whole`, none of them a part of one; columns for all `runs`. None where repeats do not
    differ by much, or by something else."""
    eq = s.design.eq
    # without a torque sensor what the wind-up has wrong goes with the motion as well
    free = [i for i in whole if (i, "A") in eq.rows and not eq.runs[i].locked and {"t", "tau_l"} <= eq.runs[i].has]
    pairs = [pair for i, j in repeats(eq.runs, free) if (pair := _pair(s, i, j)) is not None]
    if len(pairs) < FEWEST or _differ(pairs) < DIFFER:
        return None
    found = {
        by: max((_evidence(pairs, by, size, rho), rho) for size in _sizes(pairs, by) for rho in ALIKE)
        for by in pairs[0].made
    }
    late, rho = found.pop("delay")
    if late < max(other for other, _ in found.values()) + BEYOND:
        return None
    term = CURVE if rho == min(ALIKE) else ONE
    columns = {(i, c): m for i in runs for c, m in eq.term(i, term).items() if np.any(m)}
    return OwnDelays(columns, _delays(s, free, columns), term is CURVE)


def _pair(s: Solution, a: int, b: int) -> _Pair | None:
    """Of two repeats, at the same times since each began: of either some rows may be left out. None of two that are too
    short to tell noise from curves."""
    (when, first), (then, second) = (_seen(s, i) for i in (a, b))
    _, here, there = np.intersect1d(when, then, return_indices=True)
    if here.size < SHORTEST * 2 * KNOTS.size:
        return None
    first, second = ({by: x[at] for by, x in each.items()} for each, at in ((first, here), (second, there)))
    apart = first["delay"].sum(1) - second["delay"].sum(1)
    # the delay that both have is no difference, nor are zeros where every run has its own
    free = np.isinf(s.design.eq.noise.local["A"])
    shared = orthonormal(np.stack([np.full(here.size, float(free)), apart], 1))
    y = less(shared, first["y"][:, None] - second["y"][:, None])[:, 0]
    made = {by: less(shared, np.hstack([first[by], -second[by]])) for by in first if by != "y"}
    left = [float(np.sum((y - z @ np.linalg.lstsq(z, y, rcond=None)[0]) ** 2)) for z in made.values()]
    return _Pair(y, max(min(left) / (y.size - 2 * KNOTS.size), 1e-300), made)


def _seen(s: Solution, run: int) -> tuple[npt.NDArray[np.int64], dict[str, Array]]:
    """Places in time since the run began, and means there of what the model leaves of θ̃ with its zero, "y", and of the
    columns of what may differ."""
    eq, key = s.design.eq, (run, "A")
    r, delay = eq.rows[key], eq.term(run, CURVE)["A"]
    t = clock(eq, key)
    since = t - t[0]
    curve = along(since / max(float(since[-1]), 1e-9))
    torque = np.nan_to_num(at_rows(eq, key, "torque"))
    made = {
        "y": r.y - r.z @ s.x[list(r.at)],
        "delay": delay,
        "zero": curve,
        "friction": curve * np.sign(delay.sum(1))[:, None],
        "spring": curve * torque[:, None],
    }
    step = TOGETHER * float(np.median(np.diff(t)))
    when, first, count = np.unique(np.floor(since / step + 0.25).astype(int), return_index=True, return_counts=True)
    return when, {by: _means(x, first, count) for by, x in made.items()}


def _means(x: Array, first: npt.NDArray[np.int64], count: npt.NDArray[np.int64]) -> Array:
    """Of so many rows from each first one on, (n, …)."""
    return np.asarray(np.add.reduceat(x, first) / count.reshape(-1, *[1] * (x.ndim - 1)))


def _differ(pairs: Sequence[_Pair]) -> float:
    """By how much more than noise, nats, but for the pair that does so most: one run may have lost counts, and a delay
    that is another one in every run makes all of them differ."""
    return sum(sorted(float(p.y @ p.y) / p.noise - p.y.size for p in pairs)[:-1]) / 2


def _sizes(pairs: Sequence[_Pair], by: str) -> Array:
    """Of what makes them differ, about the one that makes so much of it."""
    makes = sum(float(np.sum(p.made[by] ** 2)) for p in pairs)
    return SIZES * float(np.sqrt(sum(float(p.y @ p.y) for p in pairs) / max(makes, 1e-300)))


def _evidence(pairs: Sequence[_Pair], by: str, size: float, rho: float) -> float:
    """Log of the probability that curves of that size make all of them, less that of noise alone: the same size in all
    runs, whatever their speed, correlated by `rho` along a run.     [rasmussen2006, Eq. 2.30]"""
    k = pairs[0].made[by].shape[1] // 2
    prior = np.linalg.cholesky(size**2 * (rho * np.ones((k, k)) + (1 - rho) * np.eye(k)))
    total = 0.0
    for p in pairs:
        z = np.hstack([p.made[by][:, :k] @ prior, p.made[by][:, k:] @ prior])
        right, about = z.T @ p.y / p.noise, np.eye(2 * k) + z.T @ z / p.noise
        total += 0.5 * (float(right @ np.linalg.solve(about, right)) - float(np.linalg.slogdet(about)[1]))
    return total


def _delays(s: Solution, free: Sequence[int], columns: dict[Key, Array]) -> dict[int, Array]:
    """Of the runs that are fast enough to tell [s], each with its zero."""
    eq = s.design.eq
    fast = {i: float(np.sqrt(np.mean(columns[i, "A"].sum(1) ** 2))) for i in free}
    out: dict[int, Array] = {}
    for i in (i for i, speed in fast.items() if speed > FAST * max(fast.values())):
        r, z = eq.rows[i, "A"], columns[i, "A"]
        z = np.hstack([z, np.ones((z.shape[0], 1))])
        out[i] = np.asarray(np.linalg.lstsq(z, r.y - r.z @ s.x[list(r.at)], rcond=None)[0][:-1], float)
    return out
