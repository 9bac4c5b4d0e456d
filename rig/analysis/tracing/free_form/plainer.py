"""Whether what seems to live in time or memory is a law along a plainer coordinate, as it is at the port where it acts.

Bins of one channel see the product of two things, a gain that falls with the speed under several weights, best along
whatever tells those runs apart: the time they were taken at, what the torque has been. A form at the right port needs
the one coordinate alone, and has more evidence.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Key
from rig.analysis.tracing.fit.model import Solution
from rig.analysis.tracing.free_form.fitted import Fitted, fitted, of_some_rows, possible
from rig.analysis.tracing.prepared import Prepared
from rig.analysis.tracing.rest.home import Home
from rig.analysis.tracing.thresholds import EVIDENCE, PLAIN_ENOUGH
from rig.analysis.tracing.workers import each
from rig.model.effect import Array

PLAIN: Final = ("motor_angle", "load_angle", "speed", "load", "direction")
ANYTHING: Final = frozenset({"time", "temperature", "memory"})  # of many numbers, along which runs differ anyhow


def plainer(p: Prepared, s: Solution, said: Home) -> Home | None:
    """A plain coordinate along which fitted runs want a form by far more than any along what is `said`; None where
    there is none, or that is plain itself or a step at one moment. A plain one that is said is not asked again: what
    two of them share is now and then drawn better along the wrong one."""
    if said.coordinate not in ANYTHING or said.first:
        return None
    s = of_some_rows(p, s)
    made = [(name, form) for name in (said.coordinate, *PLAIN) for form in possible(p, name) if not form.surface]
    evidence = each(lambda one: fitted(p, s, one[1]).evidence, made)
    best = int(np.argmax(evidence))
    late = max((e for e, (name, _) in zip(evidence, made, strict=True) if name == said.coordinate), default=0.0)
    name, form = made[best]
    if evidence[best] < EVIDENCE or late >= PLAIN_ENOUGH * evidence[best]:
        return None
    return Home(name, said.channel, _share(p, s, fitted(p, s, form), said.channel))


def _share(p: Prepared, s: Solution, one: Fitted, channel: str) -> float:
    """Of the excess of a channel of fitted runs, what the form takes."""

    def over(of: Mapping[Key, Array]) -> float:
        left = [of[key] / p.floors[key] for key in of if key[1] == channel]
        return float(np.mean(np.concatenate(left) ** 2)) - 1.0

    before, after = ({key: made.residual(key) for key in made.keys} for made in (s, one.solution))
    return float(np.clip(1.0 - over(after) / max(over(before), 1e-9), 0.0, 1.0))
