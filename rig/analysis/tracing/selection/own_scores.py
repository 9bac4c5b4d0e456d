"""What phases or steps that every run has to itself do for the error: their scores."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, Solution, design
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.runs.alike import alike, repeats
from rig.analysis.tracing.runs.holdout import whole_run
from rig.analysis.tracing.selection.score import overall
from rig.model.effect import Array


def own_scores(p: Prepared, s: Solution) -> dict[str, tuple[float, float]]:
    """Share of the held-out excess that goes when every run gets its own phase, or its own steps, by effect; and its
    RMS over the floor, overall. Steps between runs, where every run has a zero of its own in any case, are known from
    those zeros alone: all of it, and nothing of an error. Where no held-out run has any, of the fitted runs' excess, as
    far as they have repeats that show none of it, or nothing was repeated: it is read from single runs in any case, and
    nothing is foretold."""
    held, out = unseen(s, p.held_out), {}
    for name, mine in p.own.made.items():
        if _in_free_zeros(s, mine):
            out[name] = 1.0, 0.0
        elif keys := [key for key in held.y if key in mine]:
            out[name] = _taken(p, s, held, name, keys, p.held_out.floors)
        else:
            alone = not repeats(p.campaign.runs, range(len(p.campaign.runs)))  # whole runs: parts of one are alike
            keys = [key for key in s.design.y if key in mine and (alone or _has_repeat_without(p, key, mine))]
            out[name] = _taken(p, s, s.design, name, keys, p.held_out.seen)
    return out


def _in_free_zeros(s: Solution, mine: Mapping[Key, Array]) -> bool:
    """Whether the columns (n, q) of every block are constants beside a zero of its own."""
    local = s.design.eq.noise.local
    return all(np.isinf(local[channel]) and not np.ptp(x, axis=0).any() for (_, channel), x in mine.items())


def _taken(
    p: Prepared, s: Solution, d: Design, name: str, keys: list[Key], floors: Mapping[Key, float]
) -> tuple[float, float]:
    """From those blocks of a design that has the columns, beside one without them."""
    if not keys:
        return 0.0, 0.0
    others = replace(d.eq, own=p.own.without([name]).columns())
    bare = design(others, s.design.terms, sorted({run for run, _ in d.y}))
    before, after = ({key: _square(at, s, key) / floors[key] ** 2 for key in keys} for at in (bare, d))
    gone, n = {key: before[key] - after[key] for key in keys}, sum(d.y[key].size for key in keys)
    return sum(gone.values()) / max(sum(before.values()) - n, 0.02 * n), overall(gone, d)


def _square(d: Design, s: Solution, key: Key) -> float:
    return float(np.sum(d.residual(key, s.x) ** 2))


def _has_repeat_without(p: Prepared, key: Key, mine: Mapping[Key, Array]) -> bool:
    """Whether another run of the same condition, and no part of this one, has no columns of its own."""
    run, others = p.eq.runs[key[0]], enumerate(p.eq.runs)
    apart = [(i, other) for i, other in others if whole_run(other.name) != whole_run(run.name)]
    return any(alike(run, other) and (i, key[1]) not in mine for i, other in apart)
