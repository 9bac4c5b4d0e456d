"""Baseline and effects fitted together: weighted least squares over runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.channels import BASELINE, INDEX
from rig.analysis.tracing.fit.equations import Bare, Equations, Key, Term
from rig.analysis.tracing.thresholds import CLEAR, HEAVIER, LAG, LATEST, MESH, SECOND
from rig.model.effect import Array

STIFFNESS = 7160.0  # N·m/rad, the paper's: what turns a bound in torque into one in angle, of a gear that is no stiffer
UNSEEN = 1e-12  # of the normal matrix' diagonal: what rounding leaves of a column that is a constant
PINNED = 1e6  # times what the data know of it
HELD = 100.0  # times what noise seems to know of it


@dataclass(frozen=True)
class Part:
    """Some of the model's columns in one block, (n, k), and their places among all coefficients (k,).

    `spoilt` is what sensor noise does to them (n, k), in the blocks that stand for all; else None.
    """

    z: Bare
    at: npt.NDArray[np.int64]
    spoilt: Bare | None


@dataclass(frozen=True)
class Design:
    """Columns of every block: the baseline's part first, then one part a term that acts there. Parts are shared between
    designs, never changed. `noise` is what sensor noise does to the responses."""

    eq: Equations
    terms: tuple[Term, ...]
    widths: tuple[int, ...]
    y: dict[Key, Array]
    noise: dict[Key, Array]
    parts: dict[Key, tuple[Part, ...]]
    gram: Array  # normal matrix (p, p) and right side (p,), what sensor noise adds taken off
    right: Array

    @property
    def size(self) -> int:
        """Coefficients in all."""
        return len(BASELINE) + sum(self.widths)

    @cached_property
    def stiffness(self) -> float:
        """N·m/rad, that of the gear where it is stiffer than the paper's: its mesh drags by a smaller angle."""
        return max((STIFFNESS, *(float(run.pieces[0].gear.K) for run in self.eq.runs[:1] if run.pieces)))

    @cached_property
    def forward(self) -> float:
        """s, by how much the torque was brought forward when it was read: no more than that can be too much."""
        return max((run.look.late_torque for run in self.eq.runs[:1]), default=0.0)

    @property
    def prior(self) -> Array:
        """Information (p,) known beforehand."""
        return prior(self.size, self.stiffness)

    def place(self, term: int) -> slice:
        """Where the coefficients of a term are."""
        start = len(BASELINE) + sum(self.widths[:term])
        return slice(start, start + self.widths[term])

    def residual(self, key: Key, x: Array) -> Array:
        """What coefficients `x` (p,) or (p, m) leave in a block, (n,) or (n, m)."""
        e = self.y[key] if x.ndim == 1 else self.y[key][:, None]
        for part in self.parts[key]:
            e = e - part.z.times(x[part.at])
        return e

    def noise_left(self, key: Key, x: Array) -> Array:
        """What sensor noise does to that residual, of the same shape."""
        e = self.noise[key] if x.ndim == 1 else self.noise[key][:, None]
        for part in self.parts[key]:
            if part.spoilt is not None:
                e = e - part.spoilt.times(x[part.at])
        return e

    def whole(self, key: Key) -> tuple[Array, npt.NDArray[np.int64]]:
        """All columns of a block side by side, and their places."""
        parts = self.parts[key]
        return np.hstack([part.z.whole() for part in parts]), np.concatenate([part.at for part in parts])


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
    def gain(self) -> float:
        """How much of the weighted sum of squares of the responses the fit explains, less what its prior takes."""
        gram = self.design.gram + np.diag(self.design.prior)
        return float(2 * self.design.right @ self.x - self.x @ gram @ self.x)

    @property
    def values(self) -> dict[str, float]:
        """All baseline coefficients by name."""
        return dict(zip(BASELINE, map(float, self.x), strict=False))

    def residual(self, key: Key) -> Array:
        """What is left in a block, bare, (n,)."""
        return self.design.residual(key, self.x)


def design(eq: Equations, terms: Sequence[Term], runs: Sequence[int]) -> Design:
    """Columns of the baseline and of `terms` for those runs."""
    noisy = [i for i in runs if i in eq.noisy]

    def of(key: Key) -> tuple[Array, Part, tuple[Array, Array]]:
        r, noise = eq.rows[key], spoilt[key][1] if key in spoilt else None
        return eq.bare(key, r.y), Part(eq.baseline(key), np.array(r.at), noise), eq.products(key)

    keys = eq.of(runs)
    spoilt = {(i, c): both for i in noisy for c, both in eq.spoilt(i).items()}
    made = {key: of(key) for key in keys}
    y = {key: y for key, (y, _, _) in made.items()}
    gram, right = np.zeros((len(BASELINE), len(BASELINE))), np.zeros(len(BASELINE))
    less, less_right = np.zeros_like(gram), np.zeros_like(right)
    for key, (_, part, (across, along)) in made.items():
        w = eq.noise.weight(key[1])
        gram[np.ix_(part.at, part.at)] += w * across
        right[part.at] += w * along
        if part.spoilt is not None:  # see `normal`
            noise, v = part.spoilt.whole(), w * eq.stands_for.get(key, 0.0)
            less[np.ix_(part.at, part.at)] += v * (noise.T @ noise)
            less_right[part.at] += v * (noise.T @ spoilt[key][0])
    taken = share_taken(gram + np.diag(prior(len(BASELINE))), less)
    gram, right = gram - taken * less, right - taken * less_right
    if taken < 1.0:
        eq = replace(eq, stands_for={key: taken * v for key, v in eq.stands_for.items()})
    noise_of = {key: n for key, (n, _) in spoilt.items()}
    out = Design(eq, (), (), y, noise_of, {key: (part,) for key, (_, part, _) in made.items()}, gram, right)
    for term in terms:
        out = extended(out, term, runs)
    return out


def share_taken(gram: Array, noise: Array) -> float:
    """Share of the sensor noise (p, p) that is taken off a normal matrix (p, p): all of it, or so much that half is
    left of every sum of columns. With more of it off the fit need be no least squares any more      [fuller1987]"""
    scaled, scale = evened(gram)
    sizes, axes = np.linalg.eigh(scaled)
    root = axes / np.sqrt(np.maximum(sizes, 1e-11))
    most = float(np.linalg.eigvalsh(root.T @ (noise * scale * scale[:, None]) @ root)[-1])
    return min(1.0, CLEAR / max(most, 1e-9))


def extended(d: Design, term: Term, runs: Sequence[int], held: bool = True) -> Design:
    """The design with one more term; what of its columns is mostly sensor noise is `held` at nothing."""

    def of(run: int) -> dict[Key, tuple[Array, Array | None]]:
        made = d.eq.term(run, term)
        spoilt = d.eq.spoilt_term(run, term, made) if run in d.eq.noisy else {}
        return {(run, c): (d.eq.bare((run, c), columns), spoilt.get(c)) for c, columns in made.items()}

    made = {key: c for run in runs for key, c in of(run).items() if key in d.y}
    width = next(iter(made.values()))[0].shape[1] if made else 0
    at = np.arange(d.size, d.size + width)
    new = {key: Part(Bare(z), at, None if noise is None else Bare(noise)) for key, (z, noise) in made.items()}
    parts = {key: (*old, new[key]) if key in new else old for key, old in d.parts.items()}
    out = replace(d, terms=(*d.terms, term), widths=(*d.widths, width), parts=parts)
    part, right, noise = normal(out, new)
    part, right, noise = part[:, at], right[at], noise[np.ix_(at, at)]
    own = part[d.size :]
    if held:
        own = own + held_still(d.gram + np.diag(d.prior), part[: d.size], own, noise)
    gram = np.block([[d.gram, part[: d.size]], [part[: d.size].T, own]])
    return replace(out, gram=gram, right=np.concatenate([d.right, right]))


def held_still(gram: Array, across: Array, own: Array, noise: Array) -> Array:
    """What holds sums of a term's columns at nothing that are mostly sensor noise beside the model, (k, k): narrow
    plays that stand against each other. What is taken off leaves nothing of them, and a fit would seem to explain more
    than there is. Given are normal matrices of the model (b, b), of both (b, k), of the term, of its noise (k, k)."""
    if not noise.any():
        return np.zeros_like(own)
    scaled, scale = evened(gram)
    across = across * scale[:, None]
    size = np.sqrt(np.maximum(np.diag(own + noise), 1e-300))
    left = (own - across.T @ np.linalg.solve(scaled, across)) / size / size[:, None]
    values, vectors = np.linalg.eigh(left)
    spoilt = np.sum(vectors * ((noise / size / size[:, None]) @ vectors), axis=0)
    held = np.where(values > CLEAR * (values + spoilt), 0.0, HELD * spoilt)
    return np.asarray((vectors * held) @ vectors.T * size * size[:, None])


def normal(d: Design, new: Mapping[Key, Part]) -> tuple[Array, Array, Array]:
    """Products of all columns with the new ones (p, p), and of the new ones with y (p,), sensor noise taken off; and
    of that noise in the new ones (p, p).

    Noise in columns makes inertias come out low when it is left in. What it adds is found by adding each run's noise
    once more: products of the differences that makes      [fuller1987]
    """
    gram, right, noise = np.zeros((d.size, d.size)), np.zeros(d.size), np.zeros((d.size, d.size))
    for key in new:
        for part, mine, across, along, less in _products(d, key, new[key]):
            gram[np.ix_(part.at, mine.at)] += across
            if part is mine:
                right[mine.at] += along
                noise[np.ix_(mine.at, mine.at)] += less
    return gram, right, noise


def _products(d: Design, key: Key, mine: Part) -> list[tuple[Part, Part, Array, Array, Array | float]]:
    """Of each part of a block with `mine`, and of that one with y; and what of the first was taken off as noise."""
    w, z = d.eq.noise.weight(key[1]), mine.z.whole()
    along = w * (z.T @ d.y[key])
    v, noise = w * d.eq.stands_for.get(key, 0.0), None if mine.spoilt is None else mine.spoilt.whole()
    if noise is not None:
        along -= v * (noise.T @ d.noise[key])
    out = []
    for part in d.parts[key]:  # of a matrix with itself BLAS makes but half
        across = w * (z.T @ z if part is mine else part.z.onto(z))
        less: Array | float = 0.0
        if noise is not None and part.spoilt is not None:
            less = v * (noise.T @ noise if part is mine else part.spoilt.onto(noise))
        out.append((part, mine, across - less, along, less))
    return out


def prior(size: int, stiffness: float = STIFFNESS) -> Array:
    """Information (size,) known beforehand: the columns that may only be small."""
    out = np.zeros(size)
    out[INDEX["mesh"]] = (stiffness / MESH) ** 2
    out[INDEX["damping_2"]] = (stiffness / SECOND) ** 2
    out[INDEX["lag"]] = 1 / LAG**2
    out[INDEX["inertia"]] = 1 / HEAVIER**2
    return out


def without(s: Solution, terms: Sequence[int]) -> Solution:
    """The fit when those terms are not there: their coefficients are zero, the others find their best."""
    gone = np.concatenate([np.arange(s.design.size)[s.design.place(i)] for i in terms]) if terms else np.zeros(0, int)
    stay = np.setdiff1d(np.arange(s.design.size), gone)
    gram = s.design.gram + np.diag(s.design.prior)
    x = np.zeros(s.design.size)
    x[stay], _, _ = bounded(s.design, gram[np.ix_(stay, stay)], s.design.right[stay])
    return Solution(x, s.gram, s.right, s.design, s.keys)


def solve(gram: Array, right: Array) -> Array:
    """Least squares from normal equations, columns nobody measured left at zero."""
    scaled, scale = evened(gram)
    return np.asarray(scale * np.linalg.solve(scaled, right * scale))


def fit(d: Design) -> Solution:
    """Fit all columns of the design to its blocks."""
    x, gram, right = bounded(d, d.gram + np.diag(d.prior), d.right)
    return Solution(x, gram, right, d, tuple(d.y))


def bounded(d: Design, gram: Array, right: Array) -> tuple[Array, Array, Array]:
    """Least squares whose baseline keeps to its bounds: coefficients, and normal equations that pin those at one.

    Unbound, a drag of the mesh ten times any gear's would take the place of an encoder read late.
    """
    x = solve(gram, right)
    for name, (low, high) in {"mesh": (0.0, MESH / d.stiffness), "lag": (-d.forward, LATEST)}.items():
        i = INDEX[name]
        at = float(np.clip(x[i], low, high))
        if at != x[i]:
            pin = PINNED * max(gram[i, i], 1e-300)
            gram, right = gram.copy(), right.copy()
            gram[i, i] += pin
            right[i] += pin * at
            x = solve(gram, right)
    return x, gram, right


def inverse(gram: Array) -> Array:
    """Inverse of a normal matrix, zero where nothing was measured."""
    scaled, scale = evened(gram)
    return np.asarray(np.linalg.inv(scaled) * scale * scale[:, None])


def evened(gram: Array) -> tuple[Array, Array]:
    """A normal matrix with ones on its diagonal (p, p), and what its rows and columns were scaled by (p,), zero where
    nothing was measured."""
    seen = np.diag(gram) > UNSEEN
    scale = np.where(seen, 1 / np.sqrt(np.where(seen, np.diag(gram), 1.0)), 0.0)
    scaled = gram * scale * scale[:, None]
    scaled[np.diag_indices_from(scaled)] += np.where(scale > 0, 1e-11, 1.0)
    return scaled, scale
