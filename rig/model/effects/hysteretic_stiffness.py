"""A loop in torque against wind-up that does not depend on how fast it is gone round."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.model.effect import Array, Effect, Fit, Parameter, Port, Reach, Shape, Signals, parameter
from rig.model.memory import lagged, play, presliding


class HystereticStiffness(Effect):
    """A loop in one of seven laws, told by `law`.

    0: φ gains Σ c_i·(P_{r_i}[T] − T), what play operators stay behind the torque by: a Prandtl-Ishlinskii loop about a
    spring that is 1/K over a large swing      [kuhnen2003]

    1: φ loses (T_f/K)·z, dz/dφ = (1 − z·sgn φ̇)/x_0: friction T_f in parallel to the spring, which takes its share first
    after every reversal and whose minor loops stay open      [dahl1968]

    2: the same friction in proportion to the load, φ loses (μ/K)·|T|·z: teeth are pressed together by what they carry,
    and the loop is a wedge that closes at no torque      [wolf2018]

    3: the plays of law 0, each wider under load, φ gains Σ (c_i + d_i·|T|)·(P_{r_i}[T] − T): a loop between 0 and 2

    4: friction as in law 1 that springs back until it has let go, dz/dφ = 1/x_0 while z falls      [wen1976]

    5, 6: friction as in law 1 whose branch on the way down opens over 3·x_0, or a third of it: bristles that lie over
    to one side, as a Duhem loop whose branches are not alike may      [oh2005]

    All are rate-independent. Friction holds beside the spring and the damper, so that what it takes of the wind-up is
    late by B_sp/K, as the spring is that a torque winds up. T_h scales the half widths r_i, and is K·x_0.
    """

    name: ClassVar[str] = "hysteretic_stiffness"
    in_short: ClassVar[str] = "rate-independent loop in torque against wind-up"
    glosses: ClassVar[Mapping[str, str]] = {
        "hysteresis_loss": "wind-up between the loop's branches at zero torque",
        "loss_at_20_Nm": "wind-up between the loop's branches at 20 N·m",
        "T_h": "torque after a reversal over which the loop opens",
    }
    source: ClassVar[str] = "seyfferth1995"
    in_the_spring: ClassVar[bool] = True
    shape_names: ClassVar[tuple[str, ...]] = ("T_h", "law")
    loose: ClassVar[tuple[bool, ...]] = (True, False)
    remembers: ClassVar[bool] = True
    adds: ClassVar[frozenset[str]] = frozenset({"hysteresis_loss", "loss_at_20_Nm"})
    WIDTHS: Final = (1.5, 4.0, 10.0, 25.0)  # N·m
    SPREAD: Final = (0.25, 0.5, 1.0, 1.5, 2.0, 3.0)  # of T_h: half widths of the plays
    ABOVE_NOISE: Final = 7.0  # times sensor noise in T: by narrower plays it is led, and a fit seems to explain it
    UNMOVED: Final = 5e-6  # rad, 1 arcsec: noise of encoders goes forth and back and would wipe the memory out
    SHORT: Final = 12.0  # N·m: with a longer reach the state is the wind-up itself, and foretells what it is made from
    PLAYS, FRICTION, WEDGE, SWELLING, SPRINGS_BACK, LATE_DOWN, EARLY_DOWN = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0
    LOPSIDED: Final = {LATE_DOWN: 3.0, EARLY_DOWN: 1 / 3.0}
    OF_FRICTION: Final = (FRICTION, SPRINGS_BACK, LATE_DOWN, EARLY_DOWN)
    AT: Final = 20.0  # N·m, where the loss of a wedge is told

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Loops the campaign's torque can go round."""
        widths = [w for w in self.WIDTHS if w < 0.7 * reach.torque]
        wide = dict.fromkeys(max(w, self._least(reach)) for w in widths)
        plays, swelling = ([(w, law) for w in wide] for law in (self.PLAYS, self.SWELLING))
        wedges = [(w, self.WEDGE) for w in widths]
        friction = [(w, law) for law in self.OF_FRICTION for w in widths if w < self.SHORT]
        return (*plays, *friction, *wedges, *swelling)

    def has_state(self) -> bool:
        """A loop."""
        return True

    def moved_by_noise(self, shape: Shape) -> bool:
        """Friction is led by the wind-up of the encoders, and a count of theirs may be half of its reach."""
        return shape[1] in (*self.OF_FRICTION, self.WEDGE)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """What one operator a half width stays behind by, each once more by the load where it swells; or the friction's
        state. With the operators themselves, 1/K would be what is left of the wind-up once the narrowest has gone."""
        width, law = shape
        torque = np.ascontiguousarray(np.nan_to_num(signals.torque))
        if law in (self.PLAYS, self.SWELLING):
            behind = np.stack([play(torque, width * share) - torque for share in self.SPREAD], 1)
            by_load = behind * (np.abs(torque) / self.AT)[:, None]
            return {Port.WIND_UP: behind if law == self.PLAYS else np.hstack([behind, by_load])}
        x0, back = width / signals.gear.K, self.LOPSIDED.get(law, 1.0)
        state = presliding(self._wound(signals), x0, 0.0, law == self.SPRINGS_BACK, back)
        held = state * np.abs(torque) if law == self.WEDGE else state
        return {Port.WIND_UP: lagged(held, signals.gear.damped_for, signals.dt)[:, None]}

    def drags(self, shape: Shape) -> float:
        """A loop in the whole torque; friction's state is late as the damper is."""
        return 1.0 if shape[1] in (self.PLAYS, self.SWELLING) else 0.0

    def _wound(self, signals: Signals) -> Array:
        """φ as the encoders show it, without its noise; from the torque where one of them is missing."""
        phi = signals.theta_m / signals.ratio - signals.theta_l - signals.series_value
        if not np.isfinite(phi).all():
            phi = np.nan_to_num(signals.torque) / signals.gear.K
        return np.asarray(play(np.ascontiguousarray(phi), self.UNMOVED))

    def parameters(self, fit: Fit) -> tuple[Parameter, ...]:
        """Wind-up between the branches after a large swing, at zero torque, at AT or at both; and the scale of the half
        widths."""
        size = fit.coefficients.size
        width = np.zeros(fit.covariance.shape[0])
        width[size] = 1.0
        out = []
        for name, weights in self._gaps(fit.shape).items():
            gap = np.zeros_like(width)
            gap[:size] = weights
            out.append(parameter(name, float(weights @ fit.coefficients), fit.half_width(gap), "rad"))
        return (*out, parameter("T_h", fit.shape[0], fit.half_width(width), "N·m"))

    def plausible(self, fit: Fit) -> bool:
        """A loop loses energy: the branch on the way down lies behind, at any load."""
        return all(bool(weights @ fit.coefficients > 0) for weights in self._gaps(fit.shape).values())

    def _gaps(self, shape: Shape) -> Mapping[str, Array]:
        """What each coefficient adds to the wind-up between the branches, (k,), where that is told."""
        width, law = shape
        if law == self.WEDGE:
            return {"loss_at_20_Nm": np.array([-2.0 * self.AT])}
        if law in self.OF_FRICTION:
            return dict.fromkeys(("hysteresis_loss", "loss_at_20_Nm"), np.array([-2.0]))
        plays = 2.0 * width * np.array(self.SPREAD)
        if law == self.PLAYS:
            return dict.fromkeys(("hysteresis_loss", "loss_at_20_Nm"), plays)
        return {"hysteresis_loss": np.hstack([plays, 0.0 * plays]), "loss_at_20_Nm": np.hstack([plays, plays])}

    def bounds(self, reach: Reach) -> tuple[tuple[float, float], ...]:
        """Of T_h; the law is chosen, not fitted."""
        widths = [w for w, _ in self.shapes(reach)]
        least = max(min(widths, default=0.0) / 3, self._least(reach))
        return ((least, max(widths) * 3), (self.PLAYS, self.EARLY_DOWN)) if widths else ()

    def _least(self, reach: Reach) -> float:
        """T_h whose narrowest play is as wide as sensor noise lets one be, N·m."""
        return self.ABOVE_NOISE * reach.torque_noise / self.SPREAD[0]
