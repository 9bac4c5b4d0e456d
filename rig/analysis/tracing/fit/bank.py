"""Every effect of the library in every shape worth trying, as columns beside the rig's equations."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.crossed import Crossed
from rig.analysis.tracing.fit.equations import Equations, Key, Term
from rig.analysis.tracing.fit.laid import Block, Index, Sheet, Single
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.sliding import settled
from rig.model.effect import Array, Effect, Reach
from rig.model.second_mode.shaken import EXCITED
from rig.process.workers import each, give_back

ROOM: Final = 2  # columns of a term, more than most have in a channel

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

    @cached_property
    def crossed(self) -> Crossed:
        """What knows the products of a model's columns with it."""
        return Crossed(self.columns, self.spoilt, self.widths())

    def widths(self) -> dict[str, int]:
        """Columns per term, by index of term, as a plain dict of channel to total width."""
        return {c: max((p.stop for p in places if p is not None), default=0) for c, places in self.places.items()}


def reach(runs: Sequence[Recording]) -> Reach:
    """What the runs cover."""
    pieces = [p for run in runs for p in run.pieces]
    speeds = _speeds(runs)
    free = _speeds([run for run in runs if not run.locked])
    torque = np.concatenate([np.abs(p.torque) for p in pieces])
    way = np.concatenate([p.way for p in pieces]) if pieces else np.zeros(0)
    turns = [max(p.theta_l.max() for p in r.pieces) - min(p.theta_l.min() for p in r.pieces) for r in runs]
    return Reach(
        ratio=runs[0].ratio,
        fastest=float(np.percentile(speeds, 99.9)) if speeds.size else 0.0,
        slowest=float(np.percentile(speeds, 1)) if speeds.size else 0.0,
        slowest_free=float(np.percentile(free, 1)) if free.size else 0.0,
        torque=float(np.nanmax(torque)) if np.isfinite(torque).any() else 0.0,
        duration=max(float(p.t[-1]) for p in pieces) - min(float(p.t[0]) for p in pieces),
        rate=min(run.rate for run in runs),
        band=2.0 * _compared_at(runs),  # the low-pass leaves a seventh of it there
        load_turns=float(np.nanmax(turns)) / (2 * np.pi),
        counts_m=runs[0].counts_m,
        counts_l=runs[0].counts_l,
        has=frozenset().union(*(run.knows for run in runs)),
        runs=len(runs),
        backwards=_lesser(way),
        fast_backwards=_lesser(np.concatenate([p.omega_m * np.abs(p.omega_m) for p in pieces])),
        turned_both_ways=min(_most_turns(runs, 1.0), _most_turns(runs, -1.0)),
        pulled=_lesser(np.concatenate([p.torque * np.abs(p.torque) for p in pieces])),
        weights=len({round(float(np.nanmean(p.tau_ext)), 2) for p in pieces}),
    )


def _speeds(runs: Sequence[Recording]) -> Array:
    """Of the motor where it turns, in all rows of `runs`, rad/s."""
    speeds = [np.abs(p.omega_m[settled(p)]) for run in runs for p in run.pieces]
    return np.concatenate(speeds) if speeds else np.zeros(0)


def _compared_at(runs: Sequence[Recording]) -> float:
    """Hz of the narrowest low-pass: where fast rows are looked at, of the runs that turn fast enough to have some."""
    widths = [run.smoother.sigma_hz for run in runs if not run.look.fast or run.turning > EXCITED]
    return min(widths or [run.smoother.sigma_hz for run in runs])


def torque_noise(eq: Equations) -> float:
    """RMS of sensor noise in T of the run that has most of it, N·m."""
    made = (
        np.nanstd(np.concatenate([a.torque - b.torque for a, b in zip(noisy.pieces, eq.runs[i].pieces, strict=True)]))
        for i, noisy in eq.noisy.items()
        if any(np.isfinite(p.torque).any() for p in noisy.pieces)
    )
    return max(map(float, made), default=0.0)


def _most_turns(runs: Sequence[Recording], way: float) -> float:
    """Most output turns that one of `runs` goes that `way`, 0 where none does or nobody read the angle."""
    gone = [np.concatenate([p.theta_l[p.way * way > 0] for p in run.pieces]) for run in runs]
    return max((float(np.ptp(x)) for x in gone if x.size and np.isfinite(x).all()), default=0.0) / (2 * np.pi)


def _lesser(x: Array) -> float:
    """Of the sum of |x|, the share of the sign that has less of it."""
    x = np.nan_to_num(x)
    up, down = float(x[x > 0].sum()), float(-x[x < 0].sum())
    return min(up, down) / max(up + down, 1e-12)


def fill(eq: Equations, effects: Sequence[Effect], runs: Sequence[int], covered: Reach) -> Bank:
    """Columns of all shapes of those `effects` that the channels measured can show, for those runs: of a motor that is
    held in all of them those in the spring."""
    held = all(eq.runs[run].input_locked for run in runs)
    able = [effect for effect in effects if effect.needs <= covered.has and (effect.in_the_spring or not held)]
    terms = tuple(Term(effect, shape) for effect in able for shape in effect.shapes(covered))

    def of(run: int) -> tuple[Blocks, Blocks]:
        return _filled(eq, run, terms)

    longest = sorted(runs, key=lambda run: -_work(eq, run))  # first, or one process waits for the other in the end
    made = dict(zip(longest, each(of, longest), strict=True))
    clean, noise = Blocks(), Blocks()
    for run in runs:
        for blocks, part in zip((clean, noise), made.pop(run), strict=True):
            blocks.update(part)
    wide = {c: _widest([b for (_, channel), b in clean.items() if channel == c], len(terms)) for c in CHANNELS}
    for blocks in (clean, noise):
        _spread(blocks, wide)
    give_back()  # columns of single terms, half as much again as the bank
    return Bank(
        terms,
        {key: b.columns for key, b in clean.items()},
        {c: _places(w) for c, w in wide.items()},
        {key: b.columns for key, b in noise.items()},
        _summed({key: b.products for key, b in clean.items()}, wide),
        _summed({key: eq.stands_for[key] * b.products for key, b in noise.items()}, wide),
    )


def _work(eq: Equations, run: int) -> int:
    """Of one run, in rows."""
    return sum(piece.t.size for piece in eq.runs[run].pieces) * (2 if run in eq.noisy else 1)


Blocks = dict[Key, Block]


def _filled(eq: Equations, run: int, terms: Sequence[Term]) -> tuple[Blocks, Blocks]:
    """One run's part of the bank, and what sensor noise does to it. Term by term, so that no run's columns are held in
    double precision together."""
    rows = {c: np.flatnonzero(r.keep) for c, r in eq.kept(run).items()}
    clean, noise = ({c: Sheet(eq, (run, c), at, ROOM * len(terms)) for c, at in rows.items()} for _ in range(2))
    for term in terms:
        made = eq.unmasked_term(run, term)
        for c, sheet in clean.items():
            sheet.add(made.get(c))
        if run not in eq.noisy:
            continue
        if term.effect.moved_by_noise(term.shape):  # see `Equations.spoilt_term`
            for c, sheet in noise.items():
                sheet.add_zeros(clean[c].widths[-1])
            continue
        noisy = eq.unmasked_term(run, term, noisy=True)
        for c, sheet in noise.items():
            sheet.add(noisy[c] - made[c] if c in made else None)
    return _blocks(run, clean), _blocks(run, noise)


def _spread(blocks: Blocks, wide: Mapping[str, Index]) -> None:
    """As many columns of each term in all runs, one block after the other: side by side with those before, they would
    want twice the memory."""
    for key in blocks:
        blocks[key] = blocks[key].spread(wide[key[1]])


def _blocks(run: int, made: Mapping[str, Sheet]) -> Blocks:
    return {(run, c): block for c, sheet in made.items() if (block := sheet.block()) is not None}


def _widest(blocks: Sequence[Block], terms: int) -> Index:
    """Columns of each term in a channel (t,): a run that lacks another channel has none of what shows by it alone."""
    return np.asarray(np.max([np.zeros(terms, np.int64), *(b.widths for b in blocks)], axis=0))


def _summed(products: Mapping[Key, Array], wide: Mapping[str, Index]) -> Products:
    """Products of all runs together, by term and channel."""
    found: list[dict[str, Array]] = [{} for _ in next(iter(wide.values()))]
    for c, widths in wide.items():
        mine = [m for (_, channel), m in products.items() if channel == c]
        if mine:
            each_term = np.split(np.sum(mine, axis=0), np.cumsum(widths**2)[:-1])
            for term, k, m in zip(found, widths, each_term, strict=True):
                term[c] = m.reshape(k, k)
    return tuple(found)


def _places(wide: Index) -> tuple[slice | None, ...]:
    edges = np.concatenate([[0], np.cumsum(wide)]).tolist()
    return tuple(slice(a, b) if b > a else None for a, b in itertools.pairwise(edges))
