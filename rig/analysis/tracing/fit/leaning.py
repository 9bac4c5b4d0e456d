"""Equations made again with what a fit tells: of the gear, and of a load whose torque nobody read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Term, acting
from rig.analysis.tracing.fit.learnt import change, learnt
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.fit.rows import again
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array, Port, Signals

Terms = Sequence[tuple[Term, Array]]
"""Terms with their coefficients (k,)."""
AS_BEFORE: Final = 1e-2  # of what a load takes, RMS


def leaning(eq: Equations, s: Solution, enough: float) -> Equations:
    """With what `s` tells; the very same where that is what they lean on already, to `enough` and what effects take of
    the load to a hundredth."""
    now = learnt(s)
    moved = change(eq.runs[0].gear, now) >= enough
    known = eq.knowing(now) if moved else eq
    if not any(run.load_unread for run in eq.runs):
        return known
    return carrying(known, terms_of(s)) if moved or _differs(eq, terms_of(s)) else eq


def terms_of(s: Solution) -> Terms:
    """The effects of a solution."""
    return [(term, s.x[s.design.place(i)]) for i, term in enumerate(s.design.terms)]


def carrying(eq: Equations, terms: Terms) -> Equations:
    """With what those `terms` take of a load whose torque nobody read, in its torque; with none it is bare again."""
    loads = [(term, c) for term, c in terms if _is_of_the_load(eq, term)]
    which = {i for i, run in enumerate(eq.runs) if run.load_unread}
    if not loads and not any(eq.runs[i].carries or eq.runs[i].look.inertia for i in which):
        return eq

    def of(run: Recording) -> Recording:
        return run.carrying(_taken(loads)) if run.load_unread else run

    made = replace(eq, runs=tuple(map(of, eq.runs)), noisy={i: of(run) for i, run in eq.noisy.items()})
    fresh = {key: again(made.runs[key[0]], key[1], r) for key, r in eq.rows.items() if key[0] in which}
    return replace(made, rows={**eq.rows, **fresh})


def _taken(loads: Terms) -> Callable[[Signals], Array | None]:
    def taken(piece: Signals) -> Array | None:
        if not loads:
            return None
        return np.asarray(sum(term.effect.columns(piece, term.shape)[Port.LOAD_TORQUE] @ c for term, c in loads))

    return taken


def _is_of_the_load(eq: Equations, term: Term) -> bool:
    """Whether it acts on the load by itself: not along with a reading, nor by what the torque is."""
    run = next((run for run in eq.runs if run.load_unread), None)
    return run is not None and set(acting(run, term)[0]) == {Port.LOAD_TORQUE}


def _differs(eq: Equations, terms: Terms) -> bool:
    """Whether a load would take another torque than it does in `eq`."""
    taken = _taken([(term, c) for term, c in terms if _is_of_the_load(eq, term)])
    for run in (run for run in eq.runs if run.load_unread):
        for piece in run.pieces:
            now, before = taken(piece), piece.carried
            new = np.zeros(piece.t.size) if now is None else now
            old = np.zeros(piece.t.size) if before is None else before
            if np.linalg.norm(new - old) > AS_BEFORE * max(float(np.linalg.norm(new)), 1e-12):
                return True
    return False
