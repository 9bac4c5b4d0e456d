"""One jump in a whole campaign, under load and the way the load pulls: lost counts, or a gear that gave way.

What gives way lets the load go, and the torque sensor feels what that takes: torque and acceleration balance. A load
angle that jumps by itself seems to accelerate the load for a moment, and nobody feels it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.steps import Steps, made_by
from rig.core.units import ARCSEC
from rig.model.effect import Array

LOADED: Final = 0.2  # of the largest mean torque of a run: less winds little up
UNFELT: Final = 0.5  # of an acceleration that a jump of the reading seems to be; of the rest a load was let go
SURE: Final = 2.5  # standard errors of it: a load that was let go has none of it, and a reading all


@dataclass(frozen=True)
class OnceUnderLoad:
    """The run, when [s of the campaign], by how much θ̃ [rad], and the mean torque of the run [N·m]."""

    run: str
    at: float
    size: float
    torque: float

    def sentence(self) -> str:
        """What it may be; the encoder is one of three."""
        return (
            f"The kinematic error jumps once in the whole campaign, by {abs(self.size) / ARCSEC:.3g} arcsec at "
            f"{self.at:.0f} s in {self.run}, under {self.torque:.3g} N·m and the way that torque pulls: a spring that "
            "gave way, a clamp that slipped or an encoder that lost counts would each look so."
        )


def once_under_load(eq: Equations, e: Mapping[Key, Array], steps: Steps) -> OnceUnderLoad | None:
    """The only jump of `steps`, where what gives way would have made it; None where there are several, or the torque is
    little, or pulls the other way, or the load's balance in what is left, `e`, says that it is the reading's. Counts
    are lost either way and without load, and mostly again."""
    if sum(map(len, steps.rows.values())) != 1:
        return None
    (run, (row,)), (size,) = next(iter(steps.rows.items())), next(iter(steps.sizes.values()))
    torque, most = eq.runs[run].mean_torque, max(abs(r.mean_torque) for r in eq.runs)
    if abs(torque) < LOADED * most or size * torque <= 0 or _is_the_readings(eq, e, steps):
        return None
    return OnceUnderLoad(eq.runs[run].name, float(clock(eq, (run, "A"))[row]), size, torque)


def _is_the_readings(eq: Equations, e: Mapping[Key, Array], steps: Steps) -> bool:
    """Whether the balances of load and motor have most of the acceleration that the only jump seems to be, and surely
    so."""
    ((run, (row,)),) = steps.rows.items()
    sums = dict.fromkeys("AML", (0.0, 0.0))  # products of the jump with what is left, and with itself, over the noise
    for c, made in made_by(eq, run, row, steps.sides[run][0]).items():
        if (run, c) in e and c in sums:
            column, weight = eq.without_offset((run, c), made)[:, 0], eq.noise.weight(c)
            sums[c] = float(column @ e[run, c]) * weight, float(column @ column) * weight
    (seen, angle), (along, work) = sums["A"], np.add(sums["M"], sums["L"])
    if min(angle, work) <= 0 or seen == 0:
        return False
    # of a jump as high as that of the angle: 1 of what is in the reading alone, 0 of what the load did
    size = seen / angle
    return bool(along / work / size > max(UNFELT, SURE / (np.sqrt(work) * abs(size))))
