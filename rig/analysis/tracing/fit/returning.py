"""Inertias by that part of the acceleration which comes back with the motor's angle.

Friction that scatters within a run, and whatever else no sensor reads, is left of a balance and accelerates what it
acts on: acceleration and residual go against each other, and least squares find an inertia that is too small, by 0.1 to
3 % in runs at speed, however many there are. What makes the kinematic error come back with every turn is no such
torque, so the mean acceleration by motor angle is an instrument: by it the estimate is right  [fuller1987, sec. 1.4]

Where next to nothing of the acceleration comes back, in slow runs, it is noise of an encoder twice differentiated: that
too makes an inertia too small, and the instrument is too weak to mend it. How far the two are apart is what the
interval is wide by then.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.special import stdtrit  # of scipy.stats the import takes half a second

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import UNSEEN, Solution, solve
from rig.core.quantiles import Z95
from rig.model.effect import Array

INERTIAS: Final = {"J_m": "M", "J_l": "L"}
"""And in which channel each stands."""
PARTS: Final = 64  # of a turn of the motor: order 15 comes through whole
SHARE: Final = 0.5  # of what is left of the acceleration has to come back: less is an instrument of noise
FEWEST: Final = 4  # runs, whose differences tell how well it is known


@dataclass(frozen=True)
class Moved:
    """Coefficients (p,) with those inertias and all others at their best beside them, and what is to be added to the
    covariance (p, p) of a fit by least squares."""

    x: Array
    more: Array


@dataclass(frozen=True)
class _Along:
    """Of one inertia, by run (r,): what of residual, and of each inertia's column (r, m), lies along its instrument;
    and how much of the column came back."""

    residual: Array
    columns: Array
    share: float


def by_what_returns(s: Solution) -> Moved:
    """The solution with its inertias by what comes back with the motor's angle, those for which enough does; the others
    as unsure as they differ by it."""
    names = [name for name in INERTIAS if s.gram[INDEX[name], INDEX[name]] > UNSEEN]
    moved, unsure = Moved(s.x, np.zeros_like(s.gram)), np.zeros_like(s.gram)
    while names:
        along = _along(s, names)
        made = {name: _of(s, i, INERTIAS[name], along) for i, name in enumerate(names)}
        good = [name for name in names if made[name].share >= SHARE and made[name].residual.size >= FEWEST]
        if good == names:
            moved = _moved(s, along, list(made.values()))
            break
        for i, name in enumerate(names):
            if name not in good and made[name].share > 0:
                off = along[:, i] * (made[name].residual.sum() / made[name].columns[:, i].sum())
                unsure += np.outer(off, off)
        names = good
    return Moved(moved.x, moved.more + unsure)


def _along(s: Solution, names: list[str]) -> Array:
    """How all coefficients change with each of those inertias, by one of it, (p, m): the others are fitted again."""
    at = [INDEX[name] for name in names]
    others = np.setdiff1d(np.arange(s.x.size), at)
    out = np.zeros((s.x.size, len(at)))
    out[at, np.arange(len(at))] = 1.0
    out[others] = np.stack([-solve(s.gram[np.ix_(others, others)], s.gram[others, i]) for i in at], 1)
    return out


def _of(s: Solution, i: int, channel: str, along: Array) -> _Along:
    """The `i`-th inertia's, of all runs that turn."""
    d, residual, columns, whole = s.design, list[float](), list[Array](), 0.0
    keys = [key for key in s.keys if key[1] == channel and not d.eq.runs[key[0]].locked]
    for key in keys:
        moved = np.stack([_times(s, key, direction) for direction in along.T], 1)
        instrument = _returning(d.eq.rows[key].theta_m, moved[:, i])
        residual.append(float(instrument @ s.residual(key)))
        columns.append(instrument @ moved)
        whole += float(moved[:, i] @ moved[:, i])
    of = np.array(columns).reshape(len(keys), along.shape[1])
    return _Along(np.array(residual), of, float(of[:, i].sum()) / max(whole, 1e-300))


def _times(s: Solution, key: Key, c: Array) -> Array:
    """A block's columns times coefficients `c` (p,), (n,)."""
    parts = s.design.parts[key]
    return np.asarray(sum(part.z.times(c[part.at]) for part in parts))


def _returning(theta: Array, x: Array) -> Array:
    """Mean of `x` (n,) in each part of a turn, at every row (n,), each half of a run by the other: what scattered in a
    row is in its own mean."""
    part = np.floor(theta * (PARTS / (2 * np.pi))).astype(np.int64) % PARTS
    half = x.size // 2
    by_first, by_second = _mean_by(part[:half], x[:half]), _mean_by(part[half:], x[half:])
    return np.concatenate([by_second[part[:half]], by_first[part[half:]]])


def _mean_by(part: npt.NDArray[np.int64], x: Array) -> Array:
    """Mean of `x` (n,) in each part of a turn, zero where there is no row."""
    return np.asarray(np.bincount(part, x, PARTS) / np.maximum(np.bincount(part, minlength=PARTS), 1))


def _moved(s: Solution, along: Array, made: list[_Along]) -> Moved:
    """By how much each inertia has to move for nothing of the residual to lie along any instrument. As far as runs
    differ by it, it is not known: Student's 95 % interval is ±Z95 of what is added."""
    matrix = np.array([of.columns.sum(0) for of in made])
    size = np.linalg.solve(matrix, [of.residual.sum() for of in made])
    spread = np.diag([_spread(of.residual - of.columns @ size) for of in made])
    inverse = np.linalg.inv(matrix)
    return Moved(s.x + along @ size, along @ inverse @ spread @ inverse.T @ along.T)


def _spread(left: Array) -> float:
    """Variance of the sum of what is `left` of each run (r,), as wide as so few runs make it."""
    n = left.size
    return float(left @ left) * n / (n - 1) * (float(stdtrit(n - 1, 0.975)) / Z95) ** 2
