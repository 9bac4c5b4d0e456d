"""Where what the baseline leaves lives, once effects that explain it have been named."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import zip_longest
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.joined import loudness, rest
from rig.analysis.tracing.residual.shares import COORDINATES, PAIRS, shares
from rig.model.effect import Array

SOME: Final = 0.3  # share of the excess that a coordinate must predict
MORE: Final = 0.15  # share by which two together must beat the better one alone
LOUD: Final = 1.3  # squared residual over squared floor of a channel: less is no excess to share out
FAINTER: Final = 0.05  # of the loudest channel's excess: less is what that one's cause makes in another
MOST: Final = 3  # coordinates that are told


def lives_in(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float]) -> tuple[str, ...]:
    """Coordinates that predict residuals `e` in rows they were not fitted to; () when nothing is left.

    The best one of each channel that has something left, the loudest channel first, then the second ones; none of one
    beside which another has far more left. A fixed frequency is `time_periodic`.
    """
    over = loudness(e, floors)
    least = max(LOUD, 1 + FAINTER * (max(over.values(), default=0.0) - 1))
    loud = [channel for channel, square in over.items() if square >= least]
    ranks = zip_longest(*(_in_channel(eq, e, floors, channel) for channel in loud))
    return tuple(dict.fromkeys(name for rank in ranks for name in rank if name))[:MOST]


def _in_channel(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float], channel: str) -> list[str]:
    """Coordinates of one channel, best first."""
    if (most := rest(eq, e, floors, channel)) is None:
        return []
    found = shares(most, channel)
    score = np.nan_to_num(found[f"share.{channel}"])
    alone = dict(zip(COORDINATES, map(float, score), strict=False))
    told = {name: share for name, share in alone.items() if share > SOME}
    if len(told) > 1:
        told.pop("time", None)  # every run has a time of its own: it predicts whatever tells runs apart
    both = dict(zip(PAIRS, map(float, score[len(COORDINATES) :]), strict=True))
    pair, share = max(both.items(), key=lambda item: item[1])
    if share > SOME and share > MORE + max(alone[name] for name in pair) and share > MORE + max(alone.values()):
        told |= dict.fromkeys(pair, share)
    line = found.get(f"share_frequency_hz.{channel}")
    if line is not None and line[1] > max([SOME, *told.values()]):  # an order in runs of one speed is a frequency too
        told["time_periodic"] = float(line[1])
    return sorted(told, key=lambda name: -told[name])
