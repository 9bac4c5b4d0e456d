"""Once and twice per output turn in angle: runout of the output, or an eccentric load encoder."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals
from rig.model.gloss import waved
from rig.model.output_orders import amplitudes, below_the_first, once_or_twice, slopes, waves


class OutputOncePerRev(Effect):
    """θ̃_p gains C·cos(k·θ_l + φ), k = 1 or 2; dθ̃_p/dθ_m is 1/N of the slope in θ_l.

    An output that touches on one side, or a disc that is not round, has the next orders as well.
    """

    name: ClassVar[str] = "output_once_per_rev"
    in_short: ClassVar[str] = "once per output turn in angle"
    glosses: ClassVar[Mapping[str, str]] = waved("order_{n}", "the error in angle, {n} times an output turn", "{n}·θ_l")
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("first", "last")
    loose: ClassVar[tuple[bool, ...]] = (False, False)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a slope, less than a half has no overtones."""
        return once_or_twice(reach)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every k·θ_l."""
        found = waves(signals.theta_l, shape)
        return {Port.KINEMATIC_ERROR: found, Port.LEVER: slopes(found, shape) / signals.ratio}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase of every order."""
        return amplitudes(fit, "rad")

    def plausible(self, fit: Fit) -> bool:
        """Overtones are smaller than what they are overtones of."""
        return below_the_first(fit)
