"""How much of the excess over the floor a coordinate predicts, alone or with another, in rows it was not fitted to."""

from __future__ import annotations

from typing import Final

import numpy as np

from rig.analysis.tracing.residual.binned import Halves, folds, score
from rig.analysis.tracing.residual.bins import BINNED
from rig.analysis.tracing.residual.coordinates import INDICES
from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.unknown import frequency
from rig.model.effect import Array

SPAN: Final = 25  # rows either way, 0.2 s: the rate of a torque from row to row is mostly noise
COARSE: Final = 8  # levels of the second coordinate: loads and speeds of a campaign are about as many
RIDGE: Final = 1.0  # rows: a harmonic that no run shows stays zero
ORDERS_OF: Final = {"motor_angle": 15, "load_angle": 8}  # the paper's series; runout, ovality, gravity
COORDINATES: Final = ("motor_angle", "load_angle", "direction", "load", "memory", "speed", "time")
PAIRS: Final = (("motor_angle", "direction"), ("motor_angle", "load"), ("motor_angle", "speed"), ("speed", "direction"))


def shares(r: Rest, channel: str) -> dict[str, Array]:
    """`share.*` of one channel: bin means of one half of the rows against the other half."""
    excess = float(np.mean(r.e**2)) - 1.0
    h = Halves(r, folds(r))
    fold = h.fold
    alone = [score(h, levels(r, name)) for name in COORDINATES]
    for i, (name, orders) in enumerate(ORDERS_OF.items()):
        alone[i] = max(alone[i], score_of_orders(r, fold, name, orders))
    both = [score(h, crossed(r, *pair)) for pair in PAIRS]
    own = [channel == "L" and bool({"load", "memory"} & {*names}) for names in (*((c,) for c in COORDINATES), *PAIRS)]
    out = {f"share.{channel}": np.where(own, np.nan, np.clip(np.array(alone + both) / excess, 0.0, 1.0))}
    line = frequency(r, channel)
    if line is not None and line.frequency_hz is not None:
        out[f"share_frequency_hz.{channel}"] = np.array([line.frequency_hz, min(line.share, 1.0)])
    return out


def score_of_orders(r: Rest, fold: Array, name: str, orders: int) -> float:
    """As `score`, of the first `orders` harmonics of an angle, one size in all runs, each run with its own offset.

    What offsets alone explain is taken off. Slow runs see a sixth of an output turn: bins would not join up there.
    """
    x = r.at[name]
    if not np.isfinite(x).all():
        return 0.0
    runs, run = np.unique(r.run, return_inverse=True)
    own = np.eye(runs.size)[run]
    angles = np.multiply.outer(x, np.arange(1, orders + 1))
    waves = np.hstack([np.cos(angles), np.sin(angles)]) * r.worth[:, None]
    gain = 0.0
    for test in (0, 1):
        train, seen = fold != test, fold == test
        left = []
        for z in (own, np.hstack([own, waves])):
            normal = z[train].T @ z[train] + RIDGE * np.eye(z.shape[1])
            left.append(r.e[seen] - z[seen] @ np.linalg.solve(normal, z[train].T @ r.e[train]))
        gain += float(left[0] @ left[0] - left[1] @ left[1])
    return gain / max(r.e.size, 1)


def crossed(r: Rest, one: str, other: str) -> Index:
    """Cells of two coordinates, the second one coarse so that a cell holds rows enough; −1 where either is unknown."""
    a, b = levels(r, one), levels(r, other)
    count = int(b.max(initial=0)) + 1
    coarse = b * min(count, COARSE) // count
    return np.where((a >= 0) & (b >= 0), a * COARSE + coarse, -1)


def levels(r: Rest, name: str) -> Index:
    """Bin of each row: loads and speeds evenly on the axis they are drawn on, lest long runs take them all."""
    if name == "memory":
        load = levels(r, "load")
        return np.where(load >= 0, 2 * load + (rising(r.at["load"]) > 0), -1)
    if name not in ("load", "speed", "time"):
        return INDICES[name](r)
    found = BINNED[name](r)
    return np.full(r.e.size, -1) if found is None else np.asarray(found[0])


def rising(load: Array) -> Array:
    """How much the torque is higher in the rows after than in those before, (n,), N·m; 0 of a log shorter than that."""
    if load.size < 2 * SPAN:
        return np.zeros(load.size)
    return np.convolve(load, np.repeat([1.0, -1.0], SPAN) / SPAN, mode="same")
