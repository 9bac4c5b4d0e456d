"""Friction that is another one with direction or the angle of the output, and what hangs there."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Final

import numpy as np

from rig.analysis.tracing.nameless.law import FAST, WIDE, Amount, Nameless, sum_of, wave_of, when
from rig.core.units import TURN
from rig.model.effect import Array, Fit, Port, Reach, Shape, Signals
from rig.model.waves import wave


class UnevenDrag(Nameless):
    """The motor is dragged by more one way than the other, the more the faster: by c·|ω_m|^p      [armstrong1994]"""

    name: ClassVar[str] = "uneven_drag"
    in_short: ClassVar[str] = "the motor drags more one way"
    source: ClassVar[str] = "armstrong1994"
    shape_names: ClassVar[tuple[str, ...]] = ("power",)
    loose: ClassVar[tuple[bool, ...]] = (False,)

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Powers: of a film between lip and shaft, of a fluid, of what it stirs. Where the motor turns fast one way
        alone it is any drag."""
        return when(reach.fast_both_ways, (0.5,), (1.0,), (2.0,))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        return {Port.MOTOR_TORQUE: (np.abs(signals.omega_m) / FAST)[:, None] ** shape[0]}

    def amount(self, fit: Fit) -> Amount:
        """Between the ways."""
        return sum_of(fit, "forward the drag at 40 rad/s is larger by", 2000, "mN·m")


class SlowingDrag(Nameless):
    """Drag that grows with less than the speed, as a grease does that thins where it is sheared, or a conductor in a
    field: c·|ω_m/ω_r|^p·sgn ω_m, p < 1; or the same of the output      [wolf2018]"""

    name: ClassVar[str] = "slowing_drag"
    in_short: ClassVar[str] = "drag grows with less than the speed"
    source: ClassVar[str] = "wolf2018"
    needs: ClassVar[frozenset[str]] = frozenset({"t"})
    shape_names: ClassVar[tuple[str, ...]] = ("power", "side")
    loose: ClassVar[tuple[bool, ...]] = (False, False)
    POWERS: Final = (
        0.5,
        2 / 3,
        0.8,
    )  # of a film between lip and shaft, of grease in a contact, of one that hardly thins
    MOTOR, LOAD = 0.0, 1.0

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Of the motor, and of the load."""
        return when(reach.speeds_differ(WIDE), *((p, side) for side in (self.MOTOR, self.LOAD) for p in self.POWERS))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        power, side = shape
        speed = (signals.omega_m if side == self.MOTOR else signals.ratio * signals.omega_l) / FAST
        port = Port.MOTOR_TORQUE if side == self.MOTOR else Port.LOAD_TORQUE
        return {port: (np.sign(speed) * np.abs(speed) ** power)[:, None]}

    def amount(self, fit: Fit) -> Amount:
        """At speed, beside what grows with it."""
        whose = "of the motor" if fit.shape[1] == self.MOTOR else "of the load"
        return sum_of(fit, f"{whose}, at 40 rad/s of the motor, beside what grows with the speed, it is", 1000, "mN·m")

    def plausible(self, fit: Fit) -> bool:
        """It brakes: with the other sign it is friction that falls near rest."""
        return bool(fit.coefficients[0] > 0)


class SectorDrag(Nameless):
    """Friction of the load changes along a turn of the output: τ_k·cos(k·θ_l + φ)·sgn      [armstrong1994]"""

    name: ClassVar[str] = "sector_drag"
    in_short: ClassVar[str] = "the load's friction changes along the output's turn"
    source: ClassVar[str] = "armstrong1994"
    needs: ClassVar[frozenset[str]] = frozenset({"theta_l"})
    FAR: Final = 0.3  # of the way of the run that goes farthest: where it goes one way alone nothing is told
    ORDERS: Final = (1, 2, 3, 4, 5, 6)  # a sector of a quarter of a radian still has half its height

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where the output goes far both ways: friction that does not turn with the way is a weight."""
        return when(reach.both_ways and reach.turned_both_ways > self.FAR * reach.load_turns)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order."""
        made = [wave(k * np.nan_to_num(signals.theta_l), signals.way) for k in self.ORDERS]
        return {Port.LOAD_TORQUE: np.hstack(made)}

    def amount(self, fit: Fit) -> Amount:
        """Of the first order: of the others there may be as much."""
        return wave_of(fit, "once a turn of the output by a wave of", 1, "N·m")


class OvalPulley(Nameless):
    """What hangs on the load pulls by another lever along a turn of the output: τ_ext·cos(k·θ_l + φ), k to 2

    [tuttle1992]
    """

    name: ClassVar[str] = "oval_pulley"
    in_short: ClassVar[str] = "the lever of the external torque changes along the output's turn"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = frozenset({"theta_l"})
    ORDERS: Final = (1, 2)
    HALF: Final = 0.5  # of the mean lever

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """One, where weights differ: what one weight does is the arm's."""
        return when(reach.weights > 1)

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """Cosine and sine of every order."""
        made = [wave(k * np.nan_to_num(signals.theta_l), -signals.tau_ext) for k in self.ORDERS]
        return {Port.LOAD_TORQUE: np.hstack(made)}

    def plausible(self, fit: Fit) -> bool:
        """It stays a lever: half of it up or down is more than any pulley's."""
        waves = np.hypot(fit.coefficients[0::2], fit.coefficients[1::2])
        return bool((waves < self.HALF).all())

    def amount(self, fit: Fit) -> Amount:
        """Relative, of the first order."""
        return wave_of(fit, "once a turn of the output by a wave of", 100, "%")


class WoundCable(Nameless):
    """What is wound up by the output pulls it back, as a loom of cables about it does: k·θ_l, or k·θ_0·tanh(θ_l/θ_0)
    where its clamp slips beyond      [tuttle1992]"""

    name: ClassVar[str] = "wound_cable"
    in_short: ClassVar[str] = "a torque that grows with the output's angle"
    source: ClassVar[str] = "tuttle1992"
    needs: ClassVar[frozenset[str]] = frozenset({"theta_l"})
    shape_names: ClassVar[tuple[str, ...]] = ("theta_0",)
    loose: ClassVar[tuple[bool, ...]] = (True,)
    FAR: Final = 0.5  # turns of the output: within less a weight pulls alike
    SLIPS: Final = (0.5, 2.0)  # rad

    def shapes(self, reach: Reach) -> tuple[Shape, ...]:
        """Straight to where the output goes, or slipping before, where it goes far."""
        far = TURN * reach.load_turns
        return when(reach.load_turns > self.FAR, (10.0 * far,), *((at,) for at in self.SLIPS if at < far))

    def columns(self, signals: Signals, shape: Shape) -> Mapping[Port, Array]:
        """One column."""
        theta = np.nan_to_num(signals.theta_l)
        return {Port.LOAD_TORQUE: shape[0] * np.tanh(theta / shape[0])[:, None]}

    def plausible(self, fit: Fit) -> bool:
        """It pulls back."""
        return bool(fit.coefficients[0] > 0)

    def amount(self, fit: Fit) -> Amount:
        """Of a turn."""
        turn = fit.shape[0] * np.tanh(TURN / fit.shape[0])
        return sum_of(fit, "after a turn of the output it is more by", turn, "N·m")
