"""Every candidate tried alone beside the baseline: what it leaves on held-out runs, and the reason in words."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.answer import Candidate
from rig.analysis.tracing.fit.channels import CHANNEL, CHANNELS
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Design, extended, fit
from rig.analysis.tracing.fit.search import Scored
from rig.analysis.tracing.floor.held_out import unseen
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.thresholds import NAMED, QUIET
from rig.model.effect import Array

TAKEN: Final = "; what stands in its place explains more"


@dataclass(frozen=True)
class Tried:
    """One candidate alone: held-out RMS by channel, SI, and the share of the excess it removes in `channel`, which has
    some `over` the floor in all, or in single runs."""

    rms: dict[str, float]
    share: float
    channel: str
    over: bool = True


def candidates(
    p: Prepared,
    ranking: Sequence[Scored],
    before: Mapping[Key, Array],
    named: Sequence[str],
    confounded: Collection[str],
) -> tuple[Candidate, ...]:
    """The first round's ranking, each tried on the held-out runs whose baseline residuals are `before`. In the place of
    effects that are `confounded` a law beside the library explains more."""
    out, held = [], unseen(p.baseline, p.held_out)
    for r in ranking:
        found = tried(p, r, held, before, r.term.name in named)
        rms = {CHANNEL[c].key: value for c, value in found.rms.items()}
        why = reason(found, r.term.name, named) + (TAKEN if r.term.name in confounded else "")
        out.append(Candidate(r.term.name, r.evidence, why, rms))
    return tuple(out)


def tried(p: Prepared, r: Scored, held: Design, before: Mapping[Key, Array], is_named: bool = False) -> Tried:
    """Baseline and this one effect fitted together, in the bank's shape, and read on the held-out runs, whose design
    without any effect is `held`: in the loud channel that it changes most, or where it `is_named` in any."""
    s = fit(extended(p.baseline.design, r.term, p.split.fitted))
    after = p.held_out.residuals(s, extended(held, r.term, p.held_out.runs))
    rms: dict[str, float] = {}
    shares: dict[str, float] = {}
    changes: dict[str, float] = {}
    excess: dict[str, float] = {}
    for c in CHANNELS:
        keys = [k for k in after if k[1] == c]
        if not keys:
            continue
        rms[c] = float(np.sqrt(np.mean(np.concatenate([after[k] for k in keys]) ** 2)))
        (first, n), (left, _) = p.held_out.excess(before, keys), p.held_out.excess(after, keys)
        changes[c], excess[c] = abs(first - left), first / n
        shares[c] = (first - left) / max(first - n, 0.02 * n)
    loud = {c: change for c, change in changes.items() if is_named or excess[c] > QUIET**2} or changes
    channel = max(loud, key=lambda c: loud[c])
    return Tried(rms, float(shares[channel]), channel, excess[channel] > 1.0)


def reason(found: Tried, name: str, named: Sequence[str]) -> str:
    """One sentence on what it does alone, and beside the effects that were named."""
    quantity = CHANNEL[found.channel].name
    if name in named and not found.over and found.share > 0:
        return f"alone it lowers the held-out {quantity}, which is above its floor in single runs only"
    where = f"of the excess in the held-out {quantity}"
    if abs(found.share) < 0.005:
        return f"alone it removes nothing {where}"
    if found.share < 0:
        return f"alone it makes the held-out {quantity} worse, by {-100 * found.share:.0f} % of its excess"
    if found.share < NAMED:
        return f"alone it removes {100 * found.share:.0f} % {where}, {100 * NAMED:.0f} % would be asked for"
    needless = "" if name in named or not named else f"; beside {' and '.join(named)} it is not needed"
    return f"alone it removes {100 * min(found.share, 1.0):.0f} % {where}{needless.replace('_', ' ')}"
