"""An encoder that loses or gains counts, and reads wrong from then on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter

LOAD, MOTOR = 0.0, 1.0  # of the first shape parameter: the encoder that lost them


class MissedCounts(Effect):
    """From the instant t_0 on the reading of one angle is off by a constant step; every run has its own instants.

    The gear does not move: no torque goes with the step. What a tooth does comes back at the same angle, lost counts
    do not.
    """

    name: ClassVar[str] = "missed_counts"
    in_short: ClassVar[str] = "permanent steps in one encoder"
    glosses: ClassVar[Mapping[str, str]] = {
        "steps": "steps found in all runs",
        "step_theta_l": "usual step of the load encoder's reading, at the output",
        "step_theta_m": "usual step of the motor encoder's reading",
    }
    source: ClassVar[str] = "usdigital"
    each_run: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("side", "instant")
    loose: ClassVar[tuple[bool, ...]] = (False, True)
    INSTANTS: Final = 8  # of a campaign: where a step would show at all; the detector finds the row

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Instants all over the campaign, in either encoder."""
        instants = np.linspace(0.0, reach.duration, self.INSTANTS + 2)[1:-1]
        return tuple((side, float(t)) for side in (LOAD, MOTOR) for t in instants)

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Within the campaign."""
        return ((LOAD, MOTOR), (0.0, reach.duration))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """0 before the instant, 1 after it; a filter of rate dt sees it where it falls between two rows."""
        side, instant = shape
        after = np.clip((signals.t - instant) / signals.dt + 0.5, 0.0, 1.0)[:, None]
        return {Port.READS_THETA_M if side == MOTOR else Port.READS_THETA_L: after}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """What the reading is off by, at the shaft it belongs to."""
        along = np.zeros(fit.covariance.shape[0])
        along[0] = 1.0
        side = "m" if fit.shape[0] == MOTOR else "l"
        return (parameter(f"step_theta_{side}", fit.coefficients[0], fit.half_width(along), "rad"),)
