"""Rows without a torque in a run that has one: left out, so that no filter spreads a hole over its neighbours."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from rig.model.effect import Array

TORQUES: Final = ("tau_m", "tau_l")
Channels = Mapping[str, Array | None]


def without_holes(channels: Channels, breaks: Sequence[int]) -> tuple[dict[str, Array | None], tuple[int, ...], str]:
    """`channels`, each (n,) or None, of the rows that have every torque the run has; `breaks` counted in these rows;
    and what was left out in words, "" for nothing.

    Without a time column rows beside a hole are not joined: nobody knows how far apart they are.
    """
    holes = {name: ~np.isfinite(x) for name in TORQUES if (x := channels.get(name)) is not None}
    holes = {name: rows for name, rows in holes.items() if rows.any()}
    if not holes:
        return dict(channels), tuple(breaks), ""
    keep = ~np.any([*holes.values()], axis=0)
    before = np.concatenate([[0], np.cumsum(keep)])
    edges = list(breaks) if channels.get("t") is not None else [*breaks, *np.flatnonzero(~keep)]
    words = f"{keep.size - before[-1]} of {keep.size} rows left out: {' or '.join(holes)} was missing."
    kept = {name: None if x is None else x[keep] for name, x in channels.items()}
    return kept, tuple(sorted({int(before[i]) for i in edges})), words
