"""An order of the motor or of the output that is in the floor: where nothing was repeated, the floor is what one turn
differs from the next by, and what comes back with no whole order does. What the fitted runs show of it foretells the
others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.binned import Halves, folds
from rig.analysis.tracing.residual.foretold import unseen_beside
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.in_the_floor import square
from rig.analysis.tracing.residual.joined import rest
from rig.analysis.tracing.residual.lines import SENSES, best_order
from rig.analysis.tracing.residual.readings import in_columns, nothing
from rig.analysis.tracing.residual.unknown import MOST
from rig.analysis.tracing.residual.whose_order import WHOLE_ORDER, every_second_turn, ratio_of
from rig.analysis.tracing.runs.alike import repeats
from rig.analysis.tracing.thresholds import LOUD_LINE
from rig.model.effect import Array
from rig.process.workers import each

SOME: Final = 0.5  # of the runs: with fewer that were repeated, neighbouring turns make the floor of most
PLAIN: Final = LOUD_LINE / 2  # of what is left of the fitted runs, what one half of them must foretell of the other
NOTHING: Final = 0.01  # mean square over the floor's, of what is rounding alone: made-up numbers have no noise


def hidden_order(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float]
) -> Home | None:
    """The order of an angle that takes most of the unseen residuals, with its share of them; None where repeats tell
    the floor, or none takes enough."""
    runs = sorted({i for i, _ in fitted})
    if 2 * len(repeats(eq.runs, runs)) > SOME * len(runs):
        return None

    def best(channel: str) -> Home | None:
        found = _in_channel(eq, fitted, unseen, floors, channel)
        return max(found, key=lambda home: home.share, default=None)

    def share(channel: str) -> float:
        home = best(channel)
        return home.share if home else 0.0

    # how it was read does not go from one process to another: of the channel that has one it is looked for again
    most, channel = max(zip(each(share, WHOLE), WHOLE, strict=True))
    return best(channel) if most > LOUD_LINE else None


def _in_channel(
    eq: Equations, fitted: Mapping[Key, Array], unseen: Mapping[Key, Array], floors: Mapping[Key, float], channel: str
) -> list[Home]:
    train, keys = rest(eq, fitted, floors, channel), [key for key in unseen if key[1] == channel]
    if train is None or not keys:
        return []
    r = train.thinned(MOST)
    h = Halves(r, folds(r))
    tried = [best_order(h, "motor_angle", channel, sense) for sense in SENSES]
    # what comes back with a turn of the output comes back a whole number of times in it
    ratio = ratio_of(r)
    tried += [home for sense in SENSES if _is_its_own(home := best_order(h, "load_angle", channel, sense), ratio)]
    enough = PLAIN * float(np.mean(r.e**2)) / h.total
    plain = [home for home in tried if home is not None and home.share > enough]
    if not plain:  # in most campaigns: the unseen runs need not be asked
        return []
    beside = unseen_beside(eq, fitted, unseen, floors, channel)

    def left(home: Home) -> float:
        return square(beside.without(replace(home, own_zeros=r.own_zeros)).unseen, floors, keys)[0]

    bare = left(Home("motor_angle", channel, 0.0, read=in_columns(nothing)))
    if bare < NOTHING * sum(unseen[key].size for key in keys):
        return []
    return [replace(home, share=1.0 - left(home) / max(bare, 1e-300)) for home in plain]


def _is_its_own(home: Home | None, ratio: float) -> bool:
    """Whether an order of the output's angle is whole, and none of the motor's."""
    if home is None or home.order is None or every_second_turn(home.order, ratio):
        return False
    return abs(home.order - round(home.order)) < WHOLE_ORDER
