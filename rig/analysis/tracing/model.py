"""Baseline and effects fitted together: weighted least squares over runs, intervals from the scatter between pieces."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.campaign import WORKERS
from rig.analysis.tracing.channels import BASELINE, INDEX
from rig.analysis.tracing.equations import Equations, Key, Term
from rig.analysis.tracing.thresholds import MESH, SECOND
from rig.model.effect import Array

PIECES = 4  # of a run and channel: the clusters of the sandwich, each many correlation times long


@dataclass(frozen=True)
class Design:
    """Bare columns of every block: baseline first, then the terms'. `at` are their places among all coefficients."""

    eq: Equations
    terms: tuple[Term, ...]
    widths: tuple[int, ...]
    y: dict[Key, Array]
    z: dict[Key, Array]
    at: dict[Key, npt.NDArray[np.int64]]
    spoilt: dict[Key, tuple[Array, Array]]  # what sensor noise does to y and z, in the runs that stand for all
    gram: Array  # normal matrix (p, p) and right side (p,), what sensor noise adds taken off
    right: Array

    @property
    def size(self) -> int:
        """Coefficients in all."""
        return len(BASELINE) + sum(self.widths)

    def place(self, term: int) -> slice:
        """Where the coefficients of a term are."""
        start = len(BASELINE) + sum(self.widths[:term])
        return slice(start, start + self.widths[term])


@dataclass(frozen=True)
class Solution:
    """Coefficients (p,), their normal matrix, and the design they came from."""

    x: Array
    gram: Array
    right: Array
    design: Design
    keys: tuple[Key, ...]

    def value(self, name: str) -> float:
        """A baseline coefficient."""
        return float(self.x[INDEX[name]])

    @property
    def values(self) -> dict[str, float]:
        """All baseline coefficients by name."""
        return dict(zip(BASELINE, map(float, self.x), strict=False))

    def residual(self, key: Key) -> Array:
        """What is left in a block, bare, (n,)."""
        d = self.design
        return np.asarray(d.y[key] - d.z[key] @ self.x[d.at[key]])


def design(eq: Equations, terms: Sequence[Term], runs: Sequence[int]) -> Design:
    """Columns of the baseline and of `terms` for those runs."""
    keys = eq.of(runs)
    spoilt = {(i, c): both for i in runs if i in eq.noisy for c, both in eq.spoilt(i).items()}
    out = Design(
        eq,
        (),
        (),
        {key: eq.bare(key, eq.rows[key].y) for key in keys},
        {key: eq.bare(key, eq.rows[key].z) for key in keys},
        {key: np.array(eq.rows[key].at) for key in keys},
        spoilt,
        np.zeros((len(BASELINE), len(BASELINE))),
        np.zeros(len(BASELINE)),
    )
    gram, right = normal(out, 0)
    out = replace(out, gram=gram, right=right)
    for term in terms:
        out = extended(out, term, runs)
    return out


def extended(d: Design, term: Term, runs: Sequence[int]) -> Design:
    """The design with one more term."""

    def of(run: int) -> dict[Key, tuple[Array, Array | None]]:
        made = d.eq.term(run, term)
        spoilt = d.eq.spoilt_term(run, term, made) if run in d.eq.noisy else {}
        return {(run, c): (d.eq.bare((run, c), columns), spoilt.get(c)) for c, columns in made.items()}

    with ThreadPoolExecutor(WORKERS) as pool:
        made = {key: c for part in pool.map(of, runs) for key, c in part.items()}
    width = next(iter(made.values()))[0].shape[1] if made else 0
    new = np.arange(d.size, d.size + width)
    z = {key: np.hstack([z, made[key][0]]) if key in made else z for key, z in d.z.items()}
    at = {key: np.concatenate([at, new]) if key in made else at for key, at in d.at.items()}
    spoilt = {
        key: (y, np.hstack([z, more]) if key in made and (more := made[key][1]) is not None else z)
        for key, (y, z) in d.spoilt.items()
    }
    out = replace(d, terms=(*d.terms, term), widths=(*d.widths, width), z=z, at=at, spoilt=spoilt)
    part, right = normal(out, d.size)
    gram = np.block([[d.gram, part[: d.size]], [part[: d.size].T, part[d.size :]]])
    return replace(out, gram=gram, right=np.concatenate([d.right, right]))


def normal(d: Design, first: int) -> tuple[Array, Array]:
    """Columns of the normal matrix from `first` on (p, p − first), and of the right side, sensor noise taken off.

    Noise in columns makes inertias come out low when it is left in. What it adds is found by adding each run's noise
    once more: products of the differences that makes      [fuller1987]
    """
    gram, right = np.zeros((d.size, d.size)), np.zeros(d.size)
    for sign, blocks in ((1.0, {k: (d.y[k], z) for k, z in d.z.items()}), (-1.0, d.spoilt)):
        for key, (y, z) in blocks.items():
            at = d.at[key]
            new = at >= first
            if new.any():
                w = sign * d.eq.noise.weight(key[1]) * (d.eq.stands_for[key] if sign < 0 else 1.0)
                gram[np.ix_(at, at[new])] += w * (z.T @ z[:, new])
                right[at[new]] += w * (z[:, new].T @ y)
    return gram[:, first:], right[first:]


def prior(size: int, stiffness: float = 7160.0) -> Array:
    """Information (size,) known beforehand: the two columns that may only be small."""
    out = np.zeros(size)
    out[INDEX["mesh"]] = (stiffness / MESH) ** 2
    out[INDEX["damping_2"]] = (stiffness / SECOND) ** 2
    return out


def without(s: Solution, terms: Sequence[int]) -> Solution:
    """The fit when those terms are not there: their coefficients are zero, the others find their best."""
    gone = np.concatenate([np.arange(s.design.size)[s.design.place(i)] for i in terms]) if terms else np.zeros(0, int)
    stay = np.setdiff1d(np.arange(s.design.size), gone)
    x = np.zeros(s.design.size)
    x[stay] = solve(s.gram[np.ix_(stay, stay)], s.right[stay])
    return Solution(x, s.gram, s.right, s.design, s.keys)


def solve(gram: Array, right: Array) -> Array:
    """Least squares from normal equations, columns nobody measured left at zero."""
    scale = 1 / np.sqrt(np.maximum(np.diag(gram), 1e-300))
    scale[np.diag(gram) <= 0] = 0.0
    scaled = gram * scale * scale[:, None]
    scaled[np.diag_indices_from(scaled)] += np.where(scale > 0, 1e-11, 1.0)
    return np.asarray(scale * np.linalg.solve(scaled, right * scale))


def fit(d: Design) -> Solution:
    """Fit all columns of the design to its blocks."""
    gram = d.gram + np.diag(prior(d.size))
    return Solution(solve(gram, d.right), gram, d.right, d, tuple(d.y))


def covariance(s: Solution) -> Array:
    """Cluster-robust covariance (p, p): every run and channel in quarters      [liang1986]"""
    d = s.design
    meat, clusters = np.zeros_like(s.gram), 0
    for key in s.keys:
        w, z, at, e = d.eq.noise.weight(key[1]), d.z[key], d.at[key], s.residual(key)
        for part in np.array_split(np.arange(e.size), PIECES):
            u = w * (z[part].T @ e[part])
            meat[np.ix_(at, at)] += np.outer(u, u)
            clusters += 1
    bread = inverse(s.gram)
    return np.asarray(bread @ meat @ bread * clusters / max(1, clusters - d.size))


def inverse(gram: Array) -> Array:
    """Inverse of a normal matrix, zero where nothing was measured."""
    scale = np.where(np.diag(gram) > 0, 1 / np.sqrt(np.maximum(np.diag(gram), 1e-300)), 0.0)
    scaled = gram * scale * scale[:, None]
    scaled[np.diag_indices_from(scaled)] += np.where(scale > 0, 1e-11, 1.0)
    return np.asarray(np.linalg.inv(scaled) * scale * scale[:, None])
