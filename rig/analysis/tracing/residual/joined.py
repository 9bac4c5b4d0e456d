"""What the model leaves in one channel, all runs joined, beside every coordinate it may live in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.channels import BASELINE, WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.model import prior
from rig.model.effect import Array

ALL_OF_IT = 0.02  # of what all rows know: half of a short run leaves some of the baseline to chance
Index = npt.NDArray[np.int64]
"""The bin each row lies in, (n,); −1 in none."""


@dataclass(frozen=True)
class Whole:
    """Columns of the baseline, the rest and ones, side by side (n, p + 2); runs (r,) and the place of each row's (n,);
    products of the columns with each other, and their sums by run (r, p + 2)."""

    wide: Array
    runs: Array
    run: Index
    gram: Array
    by_run: Array


@dataclass(frozen=True)
class Rest:
    """What is left in one channel, all runs joined: residual over floor, run of each row, and coordinates by name.
    `z` (n, p) are the baseline's columns over the floor, but for those that may only be small; `known` (p, p) is what
    the other channels, and a little what all of this one, know of its coefficients, for each row. `own_zeros`: whether
    every run has a zero of its own, as angles and a torque sensor do. `timed`: whether seconds are known. `every`: one
    of how many rows each is. `worth` (n,) is how many floors that is in each row what is one
    of them in most: what has one size in all runs is a small part of the floor of a lock test. `offset` (n,) is the
    share of its run's mean that was taken off as the run's own. `sensed`: whether a torque sensor stands between gear
    and load, which sees what acts on the output."""

    e: Array
    run: Array
    at: dict[str, Array]
    dt: float
    z: Array
    known: Array
    own_zeros: bool = True
    timed: bool = True
    every: int = 1
    worth: Array = field(default_factory=lambda: np.ones(1))
    offset: Array = field(default_factory=lambda: np.zeros(1))
    sensed: bool = True

    @cached_property
    def whole(self) -> Whole:
        """Sums over all rows, which every way to read the rest begins with."""
        wide = np.column_stack([self.z, self.e, np.ones(self.e.size)])
        runs, run = np.unique(self.run, return_inverse=True)
        by_run: Array = np.stack([np.bincount(run, column, minlength=runs.size) for column in wide.T], 1)
        return Whole(wide, runs, run, np.asarray(wide.T @ wide), by_run)

    def __post_init__(self) -> None:
        for name in ("worth", "offset"):
            object.__setattr__(self, name, np.broadcast_to(getattr(self, name), self.e.shape))

    def over_the_floor(self, x: Array) -> Array:
        """Columns (n, k) of one size in all runs as they show in `e`."""
        whole = self.whole
        sums = np.array([np.bincount(whole.run, column) for column in x.T]).reshape(x.shape[1], whole.runs.size)
        mean = sums.T / whole.by_run[:, -1:]
        return np.asarray((x - mean[whole.run] * self.offset[:, None]) * self.worth[:, None])

    @property
    def by_itself(self) -> Rest:
        """The same with nothing known from the other channels."""
        return replace(self, known=ALL_OF_IT * (self.z.T @ self.z) / max(len(self.z), 1))

    def part(self, rows: Index) -> Rest:
        """Some rows of it, side by side in memory."""
        at = {name: x[rows] for name, x in self.at.items()}
        e, run, z, worth, offset = (x[rows] for x in (self.e, self.run, self.z, self.worth, self.offset))
        return replace(self, e=e, run=run, at=at, z=z, worth=worth, offset=offset)

    def thinned(self, most: int) -> Rest:
        """Every so many-th row of it, so that no more than `most` are left."""
        by = -(-self.e.size // most)
        return replace(self.part(np.arange(0, self.e.size, by)), dt=self.dt * by, every=self.every * by)


def rest(
    eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float], channel: str, beside: bool = True
) -> Rest | None:
    """Join the runs of one channel; without what stands `beside`, `z` and `known`, for those who ask where it lies."""
    keys = [k for k in e if k[1] == channel]
    if not keys:
        return None
    made = [_coordinates(eq, k) for k in keys]
    at = {name: np.concatenate([m[name] for m in made]) for name in made[0]}
    own = {"L": "load", "M": "motor_torque"}.get(channel)
    if own is not None:  # what the reading has wrong would go with the reading: the torque the model expects
        at[own] = at[own] - np.concatenate([e[k] for k in keys])
    run = np.concatenate([np.full(e[k].size, k[0]) for k in keys])
    smooth = eq.runs[keys[0][0]].smoother
    left = np.concatenate([e[k] / floors[k] for k in keys])
    z, known = _beside(eq, keys, floors, channel) if beside else (np.zeros((left.size, 0)), np.zeros((0, 0)))
    usual = float(np.median([floor for k, floor in floors.items() if k[1] == channel]))
    worth = np.concatenate([np.full(e[k].size, usual / floors[k]) for k in keys])
    offset = np.concatenate([np.full(e[k].size, eq.share_of_mean(k, e[k].size)) for k in keys])
    between = smooth.dt * smooth.step
    sensed = all("tau_l" in eq.runs[i].has for i, _ in keys)
    return Rest(left, run, at, between, z, known, channel != "M", eq.timed, worth=worth, offset=offset, sensed=sensed)


def loudness(e: Mapping[Key, Array], floors: Mapping[Key, float]) -> dict[str, float]:
    """Channels, that with the most left first, and their mean square over the floor's; 0 where one was not measured."""
    over = {c: [e[k] / floors[k] for k in e if k[1] == c] for c in WHOLE}
    square = {c: float(np.mean(np.concatenate(parts) ** 2)) if parts else 0.0 for c, parts in over.items()}
    return dict(sorted(square.items(), key=lambda item: -item[1]))


def _beside(eq: Equations, keys: Sequence[Key], floors: Mapping[Key, float], channel: str) -> tuple[Array, Array]:
    """Columns of the baseline over the floor (n, p), and what is known of their coefficients for each row (p, p)."""
    acting = {int(i) for k, rows in eq.rows.items() if k[1] == channel for i in rows.at}
    free = sorted(acting & {int(i) for i in np.flatnonzero(prior(len(BASELINE)) == 0)})
    z = np.concatenate([_baseline(eq, k)[:, free] / floors[k] for k in keys])
    runs = {run for run, _ in keys}
    known = _elsewhere(eq, [key for key in eq.of(range(len(eq.runs))) if key[1] != channel and key[0] in runs])
    return z, (known[np.ix_(free, free)] * eq.noise.kappa[channel] + ALL_OF_IT * (z.T @ z)) / len(z)


def _elsewhere(eq: Equations, keys: Sequence[Key]) -> Array:
    """What those blocks know of all the baseline's coefficients, (b, b)."""
    out = np.zeros((len(BASELINE), len(BASELINE)))
    for key in keys:
        at, (across, _) = list(eq.rows[key].at), eq.products(key)
        out[np.ix_(at, at)] += eq.noise.weight(key[1]) * across
    return out


def _baseline(eq: Equations, key: Key) -> Array:
    """All its columns, bare, (n, b)."""
    out = np.zeros((eq.rows[key].y.size, len(BASELINE)))
    out[:, list(eq.rows[key].at)] = eq.bare(key, eq.rows[key].z)
    return out


def _coordinates(eq: Equations, key: Key) -> dict[str, Array]:
    run, kept = eq.runs[key[0]], eq.rows[key].keep
    rows = [run.smoother.centres(p.t.size) for p in run.pieces]

    def of(name: str) -> Array:
        return np.asarray(np.concatenate([getattr(p, name)[r] for p, r in zip(run.pieces, rows, strict=True)])[kept])

    names = {
        "motor_angle": "theta_m",
        "load_angle": "theta_l",
        "speed": "omega_m",
        "load": "torque",
        "motor_torque": "tau_m",
        "direction": "way",
        "time": "t",
        "temperature": "temperature",
        "torque_rate": "torque_rate",
    }
    return {name: of(column) for name, column in names.items()}
