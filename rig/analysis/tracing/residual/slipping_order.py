"""An order of the motor that is in the floor, for it has another phase in every run: repeats differ by it, and no run
foretells another's."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import WHOLE
from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.residual.home import Home
from rig.analysis.tracing.residual.joined import rest
from rig.analysis.tracing.residual.own_phases import each_run, found, taken
from rig.analysis.tracing.residual.unknown import MOST
from rig.analysis.tracing.residual.whose_order import of_the_output
from rig.analysis.tracing.thresholds import LOUD_LINE
from rig.model.effect import Array
from rig.process.workers import each

MANY: Final = 0.5  # of the runs show it, where it makes their floor


def slipping_order(eq: Equations, fitted: Mapping[Key, Array], floors: Mapping[Key, float]) -> Home | None:
    """With its share of what is left of the runs that show it, in squares; None where no order takes enough of most
    runs. `fitted`: residuals (n,) by block."""
    shares = each(lambda channel: home.share if (home := _in_channel(eq, fitted, floors, channel)) else 0.0, WHOLE)
    most, channel = max(zip(shares, WHOLE, strict=True))
    # how it is read does not go from one process to another: of the channel that has one it is looked for again
    return _in_channel(eq, fitted, floors, channel) if most > LOUD_LINE else None


def _in_channel(eq: Equations, fitted: Mapping[Key, Array], floors: Mapping[Key, float], channel: str) -> Home | None:
    joined = rest(eq, fitted, floors, channel)
    r = joined.thinned(MOST) if joined else None
    if r is None or (order := found(r)) is None:
        return None
    k, shown = order
    if len(shown) < MANY * np.unique(r.run).size:
        return None
    takes = sum(taken(r, shown, k)) / sum(float(r.e[rows] @ r.e[rows]) for rows in shown)
    return of_the_output(Home("motor_angle", channel, takes, order=k, read=each_run(r, shown, k)), r)
