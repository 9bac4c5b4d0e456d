"""Every effect of the library in every shape worth trying, as columns beside the rig's equations."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.campaign import WORKERS
from rig.analysis.tracing.channels import CHANNELS
from rig.analysis.tracing.equations import Equations, Key, Term
from rig.analysis.tracing.recording import Recording
from rig.model.effect import Effect, Reach

Single = npt.NDArray[np.float32]


@dataclass(frozen=True)
class Bank:
    """`terms` and, by block, their bare columns side by side (n, c) in single precision with the place of each.

    `places[channel][i]` is the slice of term i in that channel, or None.
    """

    terms: tuple[Term, ...]
    columns: dict[Key, Single]
    places: dict[str, tuple[slice | None, ...]]
    spoilt: dict[Key, Single]  # what sensor noise does to the columns, in a few runs that stand for all (n, c)

    def widths(self) -> dict[str, int]:
        """Columns per term, by index of term, as a plain dict of channel to total width."""
        return {c: max((p.stop for p in places if p is not None), default=0) for c, places in self.places.items()}


def reach(runs: Sequence[Recording]) -> Reach:
    """What the runs cover."""
    pieces = [p for run in runs for p in run.pieces]
    speeds = np.concatenate([np.abs(p.omega_m[p.way != 0]) for p in pieces]) if pieces else np.zeros(0)
    torque = np.concatenate([np.abs(p.torque) for p in pieces])
    turns = [np.ptp(p.theta_l if np.isfinite(p.theta_l).all() else p.theta_m / p.ratio) for p in pieces]
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
    )


def fill(eq: Equations, effects: Sequence[Effect], runs: Sequence[int], covered: Reach) -> Bank:
    """Columns of all shapes of `effects` for those runs."""
    terms = tuple(Term(effect, shape) for effect in effects for shape in effect.shapes(covered))

    def of(run: int) -> tuple[int, list[dict[str, Single]], list[dict[str, Single]]]:
        made = [eq.term(run, term) for term in terms]
        bare = [{c: eq.bare((run, c), m).astype(np.float32) for c, m in cols.items()} for cols in made]
        if run not in eq.noisy:
            return run, bare, []
        spoilt = [eq.spoilt_term(run, term, clean) for term, clean in zip(terms, made, strict=True)]
        return run, bare, [{c: m.astype(np.float32) for c, m in cols.items()} for cols in spoilt]

    with ThreadPoolExecutor(WORKERS) as pool:
        found = list(pool.map(of, runs))
    places = {c: _places(c, [made for _, made, _ in found], len(terms)) for c in CHANNELS}
    return Bank(
        terms,
        {key: m for run, made, _ in found for key, m in _joined(run, made).items()},
        places,
        {key: m for run, _, spoilt in found if spoilt for key, m in _joined(run, spoilt).items()},
    )


def _joined(run: int, made: Sequence[dict[str, Single]]) -> dict[Key, Single]:
    return {(run, c): np.hstack([m[c] for m in made if c in m]) for c in CHANNELS if any(c in m for m in made)}


def _places(channel: str, found: Sequence[list[dict[str, Single]]], terms: int) -> tuple[slice | None, ...]:
    for made in found:
        if any(channel in m for m in made):
            edges, out = 0, []
            for m in made:
                wide = m[channel].shape[1] if channel in m else 0
                out.append(slice(edges, edges + wide) if wide else None)
                edges += wide
            return tuple(out)
    return (None,) * terms
