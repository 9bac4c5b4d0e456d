"""Once and twice per output turn in angle: runout of the output, or an eccentric load encoder."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic
from rig.model.waves import wave


class OutputOncePerRev(Effect):
    """θ̃_p gains C·cos(k·θ_l + φ), k = 1 or 2; dθ̃_p/dθ_m is 1/N of the slope in θ_l."""

    name: ClassVar[str] = "output_once_per_rev"
    in_short: ClassVar[str] = "once per output turn in angle"
    source: ClassVar[str] = "ghorbel2001"
    shape_names: ClassVar[tuple[str, ...]] = ("order",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Less than a sixth of an output turn looks like a slope."""
        return ((1.0,), (2.0,)) if reach.load_turns > 1 / 6 else ()

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of k·θ_l."""
        x = shape[0] * signals.theta_l
        lever = shape[0] / signals.ratio
        waves = wave(x)
        return {Port.KINEMATIC_ERROR: waves, Port.LEVER: waves[:, ::-1] * (-lever, lever)}

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Amplitude and phase."""
        return harmonic(fit, f"order_{fit.shape[0]:g}", "rad")
