"""A dead zone at zero torque."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter


class LostMotion(Effect):
    """φ gains b·T/(|T| + ε): the gap is crossed at next to no torque, on either side K holds as before

    ε only makes the jump finite; what the gap itself does needs the torque form of the refit.
    """

    name: ClassVar[str] = "lost_motion"
    in_short: ClassVar[str] = "dead zone at zero torque (Oldham backlash)"
    glosses: ClassVar[Mapping[str, str]] = {
        "gap": "2b, the whole dead zone at the output",
    }
    source: ClassVar[str] = "harmonicdrive"
    backbone: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("epsilon",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    WIDTHS: Final = (0.05, 0.15, 0.4)  # N·m: noise of a torque sensor to the least that counts as soft wind-up

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Widths well inside the torque reached."""
        return tuple((e,) for e in self.WIDTHS if e < 0.1 * reach.torque)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.WIND_UP: (signals.torque / (np.abs(signals.torque) + shape[0]))[:, None]}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The whole gap, 2b."""
        gap = np.zeros(fit.covariance.shape[0])
        gap[0] = 2.0
        return (parameter("gap", 2.0 * fit.coefficients[0], fit.half_width(gap), "rad"),)

    def plausible(self, fit: Fit) -> bool:
        """A gap is open."""
        return bool(fit.coefficients[0] > 0)
