"""One jump in a whole campaign, under load and the way the load pulls: lost counts, or a gear that gave way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from rig.analysis.tracing.fit.equations import Equations
from rig.analysis.tracing.floor.local import clock
from rig.analysis.tracing.floor.steps import Steps
from rig.core.units import ARCSEC

LOADED: Final = 0.2  # of the largest mean torque of a run: less winds little up


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


def once_under_load(eq: Equations, steps: Steps) -> OnceUnderLoad | None:
    """The only jump of `steps`, where what gives way would have made it; None where there are several, or the torque is
    little, or pulls the other way. Counts are lost either way and without load, and mostly again."""
    if sum(map(len, steps.rows.values())) != 1:
        return None
    (run, (row,)), (size,) = next(iter(steps.rows.items())), next(iter(steps.sizes.values()))
    torque, most = eq.runs[run].mean_torque, max(abs(r.mean_torque) for r in eq.runs)
    if abs(torque) < LOADED * most or size * torque <= 0:
        return None
    return OnceUnderLoad(eq.runs[run].name, float(clock(eq, (run, "A"))[row]), size, torque)
