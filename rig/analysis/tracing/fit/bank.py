"""Every effect of the library in every shape worth trying, as columns beside the rig's equations."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.fit.laid import Single, laid
from rig.analysis.tracing.runs.recording import Recording, settled
from rig.analysis.tracing.workers import each
from rig.model.effect import Array, Effect, Reach

Products = tuple[dict[str, Array], ...]
"""By term and channel, (k, k)."""


@dataclass(frozen=True)
class Bank:
    """`terms` and, by block, their bare columns side by side (n, c) in single precision with the place of each.

    `places[channel][i]` is the slice of term i in that channel, or None.
    """

    terms: tuple[Term, ...]
    columns: dict[Key, Single]
    places: dict[str, tuple[slice | None, ...]]
    spoilt: dict[Key, Single]  # what sensor noise does to the columns, in a few runs that stand for all (n, c)
    gram: Products  # of the columns of each term with each other, all runs together
    spoilt_gram: Products  # the same of what noise does to them, for all runs

    def widths(self) -> dict[str, int]:
        """Columns per term, by index of term, as a plain dict of channel to total width."""
        return {c: max((p.stop for p in places if p is not None), default=0) for c, places in self.places.items()}


def reach(runs: Sequence[Recording]) -> Reach:
    """What the runs cover."""
    pieces = [p for run in runs for p in run.pieces]
    speeds = np.concatenate([np.abs(p.omega_m[settled(p)]) for p in pieces]) if pieces else np.zeros(0)
    torque = np.concatenate([np.abs(p.torque) for p in pieces])
    turns = [max(p.theta_l.max() for p in r.pieces) - min(p.theta_l.min() for p in r.pieces) for r in runs]
    return Reach(
        ratio=runs[0].ratio,
        fastest=float(np.percentile(speeds, 99.9)) if speeds.size else 0.0,
        slowest=float(np.percentile(speeds, 1)) if speeds.size else 0.0,
        torque=float(np.nanmax(torque)) if np.isfinite(torque).any() else 0.0,
        duration=max(float(p.t[-1]) for p in pieces) - min(float(p.t[0]) for p in pieces),
        rate=min(run.rate for run in runs),
        band=2.0 * min(run.smoother.sigma_hz for run in runs),  # the low-pass leaves a seventh of it there
        load_turns=float(np.nanmax(turns)) / (2 * np.pi),
        counts_m=runs[0].counts_m,
        counts_l=runs[0].counts_l,
        has=frozenset().union(*(run.knows for run in runs)),
    )


def fill(eq: Equations, effects: Sequence[Effect], runs: Sequence[int], covered: Reach) -> Bank:
    """Columns of all shapes of those `effects` that the channels measured can show, for those runs."""
    able = [effect for effect in effects if effect.needs <= covered.has]
    terms = tuple(Term(effect, shape) for effect in able for shape in effect.shapes(covered))

    def of(run: int) -> _Filled:
        return _filled(eq, run, terms)

    found = each(of, runs)
    wide = {c: [max(f.widths[i].get(c, 0) for f in found) for i in range(len(terms))] for c in CHANNELS}
    columns = {key: _spread(m, f.widths, key[1], wide) for f in found for key, m in f.columns.items()}
    spoilt = {key: _spread(m, f.spoilt_widths, key[1], wide) for f in found for key, m in f.spoilt.items()}
    gram = _added([f.gram for f in found], len(terms), [dict.fromkeys(CHANNELS, 1.0)] * len(found))
    stand = [{c: eq.stands_for.get((run, c), 0.0) for c in CHANNELS} for run in runs]
    spoilt_gram = _added([f.spoilt_gram for f in found], len(terms), stand)
    return Bank(terms, columns, {c: _places(w) for c, w in wide.items()}, spoilt, gram, spoilt_gram)


@dataclass(frozen=True)
class _Filled:
    """One run's part of the bank; columns of each term by channel, and their products with each other."""

    columns: dict[Key, Single]
    spoilt: dict[Key, Single]
    widths: list[dict[str, int]]
    spoilt_widths: list[dict[str, int]]
    gram: list[dict[str, Array]]
    spoilt_gram: list[dict[str, Array]]


def _filled(eq: Equations, run: int, terms: Sequence[Term]) -> _Filled:
    """Term by term, so that no run's columns are held in double precision together."""
    bare: list[dict[str, Single]] = []
    spoilt: list[dict[str, Single]] = []
    rows = {c: np.flatnonzero(r.keep) for c, r in eq.kept(run).items()}
    for term in terms:
        made = eq.unmasked_term(run, term)
        bare.append({c: laid(eq, (run, c), m, rows[c]) for c, m in made.items()})
        if run not in eq.noisy:
            continue
        if term.effect.moved_by_noise():  # see `Equations.spoilt_term`
            spoilt.append({c: np.zeros_like(m) for c, m in bare[-1].items()})
            continue
        noisy = eq.unmasked_term(run, term, noisy=True)
        spoilt.append({c: laid(eq, (run, c), noisy[c] - m, rows[c]) for c, m in made.items()})
    return _Filled(
        _joined(run, bare), _joined(run, spoilt), _widths(bare), _widths(spoilt), _products(bare), _products(spoilt)
    )


def _products(made: Sequence[dict[str, Single]]) -> list[dict[str, Array]]:
    """Of the columns of each term with each other, by channel, (k, k)."""
    double = ({c: m.astype(np.float64) for c, m in columns.items()} for columns in made)
    return [{c: m @ m.T for c, m in columns.items()} for columns in double]


def _added(parts: Sequence[Sequence[Mapping[str, Array]]], terms: int, by: Sequence[Mapping[str, float]]) -> Products:
    """Products of all runs together, those of a run and channel `by` times."""
    out: Products = tuple({} for _ in range(terms))
    for part, times in zip(parts, by, strict=True):
        for total, mine in zip(out, part, strict=False):
            for c, m in mine.items():
                known = total.get(c)
                k = max(len(m), 0 if known is None else len(known))
                total[c] = _wide(m, k) * times[c] + (0.0 if known is None else _wide(known, k))
    return out


def _wide(m: Array, k: int) -> Array:
    """A matrix with rows and columns of nothing to (k, k): a run that lacks a channel has fewer columns."""
    return m if len(m) == k else np.pad(m, (0, k - len(m)))


def _widths(made: Sequence[dict[str, Single]]) -> list[dict[str, int]]:
    return [{c: len(m) for c, m in columns.items()} for columns in made]


def _spread(
    columns: Single, widths: Sequence[Mapping[str, int]], channel: str, wide: Mapping[str, Sequence[int]]
) -> Single:
    """The columns of one block at their places: a run that lacks a channel has none of what shows by it alone."""
    mine = [w.get(channel, 0) for w in widths]
    if mine == list(wide[channel]):
        return columns
    out = np.zeros((columns.shape[0], sum(wide[channel])), np.float32, order="F")
    start, at = 0, 0
    for has, takes in zip(mine, wide[channel], strict=True):
        out[:, at : at + has] = columns[:, start : start + has]
        start, at = start + has, at + takes
    return out


def _joined(run: int, made: Sequence[dict[str, Single]]) -> dict[Key, Single]:
    """All columns of a block side by side, (n, c), each in one stretch of memory."""
    return {(run, c): np.vstack([m[c] for m in made if c in m]).T for c in CHANNELS if any(c in m for m in made)}


def _places(wide: Sequence[int]) -> tuple[slice | None, ...]:
    edges = np.concatenate([[0], np.cumsum(wide)]).tolist()
    return tuple(slice(a, b) if b > a else None for a, b in itertools.pairwise(edges))
