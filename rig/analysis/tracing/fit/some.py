"""The search on a bounded number of rows: stretches of every run, evenly over it.

What the search asks is which laws explain most, and a law that is worth its name shows in a quarter of an hour of rows.
A longer campaign costs no more to search; what is found is fitted, selected and reported on all of its rows. Within a
stretch rows are what they were, so that floors, and how alike neighbouring rows are, stay as measured.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.bank import Bank
from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.fit.leaning import carrying, terms_of
from rig.analysis.tracing.fit.model import Design, Solution, design, fit
from rig.analysis.tracing.fit.rows import Rows
from rig.analysis.tracing.fit.search import Found, Scored, ranking_beside, search
from rig.analysis.tracing.runs.recording import Recording
from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Reach

PERIOD: Final = 12.0  # s from one stretch to the next: a slow motor turns twice
WORTH: Final = 0.9  # of a run's rows: a shortened one is a copy

Chosen = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Bounds:
    """So many rows of the fitted runs in a channel are `most` that are all taken, and about `left` of more than those;
    of a run that has fewer than `fewest` in all its channels none are left out."""

    most: int
    left: int
    fewest: int


SEARCHED: Final = Bounds(77_000, 40_000, 2000)  # half an hour of campaign; what is found is fitted to all rows again


@dataclass(frozen=True)
class Stretches:
    """What is left of one run: `wanted` rows of its equations (m,), the rows of its pieces that these are made from,
    piece by piece, and where they lie (m',) among the rows that those make."""

    wanted: Chosen
    of_pieces: tuple[npt.NDArray[np.int64], ...]
    made: Chosen

    def shorter(self, run: Recording) -> bool:
        """Whether that saves a good part of the work on a run."""
        return sum(rows.size for rows in self.of_pieces) < WORTH * sum(p.t.size for p in run.pieces)

    def recording(self, run: Recording) -> Recording:
        """The run with those rows alone."""
        pieces = tuple(p.part(rows) for p, rows in zip(run.pieces, self.of_pieces, strict=True) if rows.size)
        return replace(run, pieces=pieces)

    def of(self, rows: Rows) -> Chosen:
        """Which of the rows of a channel are left, (n,)."""
        return self.wanted[np.flatnonzero(rows.keep)]

    def rows(self, rows: Rows) -> Rows:
        """Those rows of a channel."""
        left, keep = self.of(rows), np.zeros_like(rows.keep, shape=self.made.shape)
        keep[self.made] = rows.keep[self.wanted]
        return replace(rows, y=rows.y[left], z=rows.z[left], keep=keep, theta_m=rows.theta_m[left], own=rows.own[left])


def some(eq: Equations, runs: Sequence[int], bounds: Bounds | None = None) -> Equations:
    """Equations with as many rows of `runs` in the fullest channel as the `bounds` say, those of a search unless others
    are given. And with no rows of the pieces that no equation is made from: a locked run is read stay by stay."""
    bounds = bounds or SEARCHED
    count = {c: sum(eq.rows[i, c].y.size for i in runs if (i, c) in eq.rows) for c in CHANNELS}
    most = max(*count.values(), 1)
    share = 1.0 if most <= bounds.most else bounds.left / most
    left = {i: stretches(eq, i, share, bounds.fewest) for i in runs if eq.kept(i)}
    left = {i: s for i, s in left.items() if s.shorter(eq.runs[i])}
    cut = {key: left[key[0]].rows(r) if key[0] in left else r for key, r in eq.rows.items()}
    rows = {key: r for key, r in cut.items() if r.y.size}  # a lock test may have a dozen in M, and none of them here
    kept = {c: sum(rows[i, c].y.size for i in runs if (i, c) in rows) / max(n, 1) for c, n in count.items()}

    def stands_for(key: Key, before: float) -> float:
        """Rows of all like it over its own: both are fewer now."""
        return before * kept[key[1]] * eq.rows[key].y.size / max(rows[key].y.size, 1)

    return replace(
        eq,
        runs=tuple(left[i].recording(run) if i in left else run for i, run in enumerate(eq.runs)),
        rows=rows,
        own={k: x[left[k[0]].of(eq.rows[k])] if k[0] in left else x for k, x in eq.own.items() if k in rows},
        noisy={i: left[i].recording(run) if i in left else run for i, run in eq.noisy.items()},
        stands_for={key: stands_for(key, before) for key, before in eq.stands_for.items() if key in rows},
    )


def search_some(
    d: Design, bank: Bank, runs: Sequence[int], covered: Reach, floors: Mapping[Key, float], **how: Any
) -> Found:
    """As `search` of `d`, on `some` of its rows; what is found is fitted to all of them."""
    few, whole = of_some(d, runs)
    found = search(few, bank, runs, tuple(few.y), covered, floors, **how)
    if found.solution.design.terms == d.terms:
        return replace(found, solution=fit(d))
    s, same = _of_all(found.solution, d.eq, runs)
    again = s if whole and same else fit(design(s.design.eq, s.design.terms, runs))
    return replace(found, solution=again, rough=not whole)


def ranking_of_some(d: Design, bank: Bank, runs: Sequence[int], covered: Reach, nearly: float) -> tuple[Scored, ...]:
    """As `ranking_beside` the design, on `some` of its rows."""
    few, _ = of_some(d, runs)
    return ranking_beside(few, bank, runs, tuple(few.y), covered, nearly)


def of_some(d: Design, runs: Sequence[int], bounds: Bounds | None = None) -> tuple[Design, bool]:
    """A design with `some` of its rows, and whether they are all."""
    eq = some(d.eq, runs, bounds)
    whole = all(eq.rows[key].y.size == y.size for key, y in d.y.items())
    return (replace(d, eq=eq) if whole else design(eq, d.terms, runs)), whole


def _of_all(s: Solution, eq: Equations, runs: Sequence[int]) -> tuple[Solution, bool]:
    """A solution with all rows of `eq`, and what is known of the gear by now; whether its own columns are the same."""
    known = eq.knowing(s.design.eq.runs[runs[0]].gear)
    whole = carrying(known, terms_of(s))
    return replace(s, design=replace(s.design, eq=whole)), whole.rows is eq.rows


def stretches(eq: Equations, run: int, share: float, fewest: int) -> Stretches:
    """Of each period of the run the first `share`, and all reversals: they are few, and friction shows its memory there
    alone. Of a run with few rows all."""
    recording, kept = eq.runs[run], eq.kept(run)
    f, sizes = recording.smoother, [recording.smoother.rows(p.t.size) for p in recording.pieces]
    period = PERIOD / (f.dt * f.step)
    few = sum(r.y.size for r in kept.values()) < fewest
    used = np.any([r.keep for r in kept.values()], axis=0)
    turning = kept["R"].keep if "R" in kept else np.zeros_like(used)
    made = []
    for piece, at in zip(recording.pieces, np.split(np.arange(used.size), np.cumsum(sizes)[:-1]), strict=True):
        asked = used[at] & (few | turning[at] | (at % period < share * period))
        made.append(laid_out(f, asked, piece.t.size))
    of_pieces, wanted, local = zip(*made, strict=True)
    return Stretches(np.concatenate(wanted), of_pieces, np.concatenate(local))


def laid_out(f: Smoother, asked: Chosen, n: int) -> tuple[npt.NDArray[np.int64], Chosen, Chosen]:
    """Of a piece of `n` rows: those that the `asked` rows (m,) of its equations are made from, stretches side by side;
    the rows (m,) asked for, with those between stretches that would touch; and where these lie (m',) in what `f` makes
    of all stretches together. A stretch begins at a row that `f` keeps, there as here.
    """
    reach = -(-(2 * f.half + 1) // f.step)  # rows of the equations between two that share no row of the piece
    edges = np.flatnonzero(np.diff(asked, prepend=False, append=False)).reshape(-1, 2)
    apart = edges[1:, 0] - edges[:-1, 1] >= 2 * reach
    starts = edges[np.concatenate([[True], apart]), 0] if len(edges) else edges[:, 0]
    stops = edges[np.concatenate([apart, [True]]), 1] if len(edges) else edges[:, 1]
    here = np.zeros(asked.size, dtype=np.bool_)
    rows: list[npt.NDArray[np.int64]] = []
    local: list[npt.NDArray[np.bool_]] = []
    for start, stop in zip(starts.tolist(), stops.tolist(), strict=True):
        here[start:stop] = True
        length = stop - start + reach  # whole steps, the last rows of which are only for the low-pass
        rows.append(np.arange(start * f.step, min((start + length) * f.step, n)))
        local.append(np.arange(length) < stop - start)
    if not rows:
        return np.zeros(0, np.int64), here, np.zeros(0, np.bool_)
    taken = np.concatenate(rows)
    return taken, here, np.concatenate(local)[: f.rows(taken.size)]
