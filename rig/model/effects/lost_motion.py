"""A dead zone at zero torque."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, harmonic, parameter
from rig.model.waves import wave

EVEN, BY_ANGLE = 0.0, 1.0  # of the last shape parameter: the same all round, or wider at some angles of the motor


NARROW: Final = 0.25  # of the gap: so far below nothing it may seem to go where it closes altogether


class LostMotion(Effect):
    """φ gains b·tanh(T_e/ε), T_e what the spring holds of T: the gap is crossed while the spring is slack, on either
    side K holds as before

    In the gap the damper still drags, at 300 rpm a few tenths of a newton metre: by T itself the crossing would come
    late. ε only makes the jump finite. A law with a longer tail makes the gap 5 to 10 % too wide. The slop of an Oldham
    coupling may be wider at one angle, or at every half turn as its slider crosses: b gains b_1·cos(θ_m + φ_1) and
    b_2·cos(2·θ_m + φ_2).
    """

    name: ClassVar[str] = "lost_motion"
    in_short: ClassVar[str] = "dead zone at zero torque (Oldham backlash)"
    glosses: ClassVar[Mapping[str, str]] = {
        "gap": "2b, the whole dead zone at the output",
        "gap_by_angle_amplitude": "2b_1, by how much it is wider at one angle of the motor",
        "gap_by_angle_phase": "φ of that angle, cos(θ_m + φ)",
        "gap_by_half_turn_amplitude": "2b_2, by how much it is wider every half turn of the motor",
        "gap_by_half_turn_phase": "φ of that, cos(2·θ_m + φ)",
    }
    source: ClassVar[str] = "harmonicdrive"
    in_the_spring: ClassVar[bool] = True
    backbone: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("epsilon", "kind")
    loose: ClassVar[tuple[bool, ...]] = (True, False)
    usual: ClassVar[Mapping[str, tuple[float, ...]]] = MappingProxyType({"kind": (EVEN,)})
    WIDTHS: Final = (0.08, 0.15, 0.4)  # N·m: noise of a torque sensor to the least that counts as soft wind-up

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Widths well inside the torque reached."""
        widths = [e for e in self.WIDTHS if e < 0.1 * reach.torque]
        return (*((e, EVEN) for e in widths), *((e, BY_ANGLE) for e in widths[1:2]))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column; five where it is wider at some angles."""
        side = np.tanh(signals.spring_torque / shape[0])
        if shape[1] == EVEN:
            return {Port.WIND_UP: side[:, None]}
        return {Port.WIND_UP: np.hstack([side[:, None], *(wave(n * signals.theta_m, side) for n in (1, 2))])}

    def drags(self, shape: Shape) -> float:
        """A curve in what the spring holds."""
        return 0.5

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """The whole gap, 2b."""
        gap = np.zeros(fit.covariance.shape[0])
        gap[0] = 2.0
        whole = parameter("gap", 2.0 * fit.coefficients[0], fit.half_width(gap), "rad")
        if fit.shape[1] == EVEN:
            return (whole,)
        return (whole, *harmonic(fit, "gap_by_angle", "rad", 1, 2.0), *harmonic(fit, "gap_by_half_turn", "rad", 3, 2.0))

    def plausible(self, fit: Fit) -> bool:
        """A gap is open, at every angle: with what is not known of it."""
        gap, *waves = fit.coefficients
        narrowest = gap - sum(float(np.hypot(*pair)) for pair in zip(waves[::2], waves[1::2], strict=True))
        return bool(gap > 0 and narrowest > -NARROW * gap)
