"""A loop in torque against wind-up that does not depend on how fast it is gone round."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import play, presliding


class HystereticStiffness(Effect):
    """A loop in one of three laws, told by `law`.

    0: φ gains Σ c_i·P_{r_i}[T], play operators of the torque: a Prandtl-Ishlinskii loop      [kuhnen2003]
    1: φ loses (T_f/K)·z, dz/dφ = (1 − z·sgn φ̇)/x_0: friction T_f in parallel to the spring, which takes its share first
    after every reversal and whose minor loops stay open      [dahl1968]

    2: the same friction in proportion to the load, φ loses (μ/K)·|T|·z: teeth are pressed together by what they carry,
    and the loop is a wedge that closes at no torque      [wolf2018]

    All are rate-independent. T_h scales the half widths r_i, and is K·x_0.
    """

    name: ClassVar[str] = "hysteretic_stiffness"
    in_short: ClassVar[str] = "rate-independent loop in torque against wind-up"
    glosses: ClassVar[Mapping[str, str]] = {
        "hysteresis_loss": "wind-up between the loop's branches at zero torque",
        "loss_at_20_Nm": "wind-up between the loop's branches at 20 N·m",
        "T_h": "torque after a reversal over which the loop opens",
    }
    source: ClassVar[str] = "seyfferth1995"
    shape_names: ClassVar[tuple[str, ...]] = ("T_h", "law")
    loose: ClassVar[tuple[bool, ...]] = (True, False)
    remembers: ClassVar[bool] = True
    adds: ClassVar[frozenset[str]] = frozenset({"hysteresis_loss", "loss_at_20_Nm"})
    WIDTHS: Final = (1.5, 4.0, 10.0, 25.0)  # N·m
    SPREAD: Final = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0)  # of T_h: half widths of the plays
    UNMOVED: Final = 1e-5  # rad, 2 arcsec: noise of encoders goes forth and back and would wipe the memory out
    SHORT: Final = 12.0  # N·m: with a longer reach the state is the wind-up itself, and foretells what it is made from
    PLAYS, FRICTION, WEDGE = 0.0, 1.0, 2.0
    AT: Final = 20.0  # N·m, where the loss of a wedge is told

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Loops the campaign's torque can go round."""
        widths = [w for w in self.WIDTHS if w < 0.7 * reach.torque]
        plays = [(w, self.PLAYS) for w in widths]
        wedges = [(w, self.WEDGE) for w in widths]
        return (*plays, *((w, self.FRICTION) for w in widths if w < self.SHORT), *wedges)

    def has_state(self) -> bool:
        """A loop."""
        return True

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One operator a half width, or the friction's state."""
        width, law = shape
        torque = np.ascontiguousarray(np.nan_to_num(signals.torque))
        if law == self.PLAYS:
            return {Port.WIND_UP: np.stack([play(torque, width * share) for share in self.SPREAD], 1)}
        state = presliding(self._wound(signals), width / signals.gear.K)
        return {Port.WIND_UP: (state * np.abs(torque) if law == self.WEDGE else state)[:, None]}

    def _wound(self, signals: Signals) -> Array:
        """φ as the encoders show it, without its noise; from the torque where one of them is missing."""
        phi = signals.theta_m / signals.ratio - signals.theta_l - signals.series_value
        if not np.isfinite(phi).all():
            phi = np.nan_to_num(signals.torque) / signals.gear.K
        return np.asarray(play(np.ascontiguousarray(phi), self.UNMOVED))

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Wind-up between the branches after a large swing, at zero torque or, of a wedge, at AT; and the scale of the
        half widths."""
        gap, width = np.zeros((2, fit.covariance.shape[0]))
        weights = self._gap(fit.shape)
        gap[: weights.size] = weights
        width[weights.size] = 1.0
        value = float(weights @ fit.coefficients[: weights.size])
        return (
            parameter(
                "loss_at_20_Nm" if fit.shape[1] == self.WEDGE else "hysteresis_loss", value, fit.half_width(gap), "rad"
            ),
            parameter("T_h", fit.shape[0], fit.half_width(width), "N·m"),
        )

    def plausible(self, fit: Fit) -> bool:
        """A loop loses energy: the branch on the way down lies behind."""
        weights = self._gap(fit.shape)
        return bool(weights @ fit.coefficients[: weights.size] > 0)

    def _gap(self, shape: Shape) -> Array:
        """What each coefficient adds to the wind-up between the branches, (k,)."""
        width, law = shape
        if law == self.PLAYS:
            return 2.0 * width * np.array(self.SPREAD)
        return np.array([-2.0 * (self.AT if law == self.WEDGE else 1.0)])

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of T_h; the law is chosen, not fitted."""
        widths = [w for w, _ in self.shapes(reach)]
        return ((min(widths) / 3, max(widths) * 3), (self.PLAYS, self.WEDGE)) if widths else ()
