"""How far the error of each channel falls on held-out runs."""

from __future__ import annotations

from collections.abc import Mapping

from rig.analysis.tracing.fit.channels import CHANNELS
from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.model.effect import Array


def _pairs(at: HeldOut, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> list[tuple[float, float]]:
    """RMS over floor without and with what was found, by channel."""
    keys = [[k for k in after if k[1] == c] for c in CHANNELS]
    return [(at.ratio(before, mine), at.ratio(after, mine)) for mine in keys if mine]


def most(at: HeldOut, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> tuple[float, float]:
    """RMS over floor without and with what was found, of the channel that gains most."""
    return max(_pairs(at, before, after), key=lambda pair: pair[0] - pair[1])


def share_of_all(at: HeldOut, before: Mapping[Key, Array], after: Mapping[Key, Array]) -> float:
    """Of the excess over the floor in all channels, what has gone: a law that explains one channel while far more is
    left in the others may be a shadow there of what those show."""
    pairs = _pairs(at, before, after)
    return sum(max(b**2 - a**2, 0.0) for b, a in pairs) / max(sum(max(b**2 - 1.0, 0.0) for b, _ in pairs), 1e-9)


def share(before: float, after: float) -> float:
    """Of the excess over the floor in a channel, what has gone."""
    return (before**2 - after**2) / max(before**2 - 1.0, 1e-9)
