"""Errors on held-out runs in physical units, each beside its floor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rig.analysis.tracing.fit.channels import CHANNEL, WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.held_out import HeldOut
from rig.analysis.tracing.outcome.result import Before, Errors
from rig.core.units import ARCSEC
from rig.model.effect import Array

UNITS = {c: 1 / ARCSEC if CHANNEL[c].unit == "rad" else 1.0 for c in WHOLE}


def errors(eq: Equations, at: HeldOut, e: Mapping[Key, Array]) -> Before:
    """Per held-out run and pooled."""
    runs = sorted({i for i, _ in e})
    return Before({eq.runs[i].name: _of([i], at, e) for i in runs}, _of(runs, at, e))


def _of(runs: Sequence[int], at: HeldOut, e: Mapping[Key, Array]) -> Errors:
    values: list[float | None] = []
    floors: list[float | None] = []
    for channel, unit in UNITS.items():
        same = [c for c, of in CHANNEL.items() if of.sensor == CHANNEL[channel].sensor]  # R is the motor torque too
        keys = [(i, c) for i in runs for c in same if (i, c) in e]
        n = sum(e[k].size for k in keys)
        values.append(float(np.sqrt(sum(e[k] @ e[k] for k in keys) / n)) * unit if n else None)
        floors.append(float(np.sqrt(sum(at.floors[k] ** 2 * e[k].size for k in keys) / n)) * unit if n else None)
    return Errors(*values, *floors)
