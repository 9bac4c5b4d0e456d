"""Whether a position loop on the host comes to rest or swings up by itself: poles of tick, delay, filter and gear."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from rig.core.drivetrain import Drivetrain
from rig.core.gains import Gains

Array = npt.NDArray[np.float64]

GROWS: Final = 1.0  # 1/s: what grows more slowly, friction holds, which is left out here
MOST: Final = 100.0  # times the gains: beyond, nobody asks
FINE: Final = 1.05  # how far apart the multiples that are tried lie


@dataclass(frozen=True)
class Loop:
    """What gains are to close the loop around: the gear as declared, s a tick, s of the speed filter. A torque is on
    its way for a tick and then stays for one."""

    drivetrain: Drivetrain
    period: float
    filter_time: float

    def swings_up(self, gains: Gains) -> bool:
        """Whether it does so as it is."""
        return self.growth(gains) > GROWS

    def margin(self, gains: Gains) -> float:
        """By what all of `gains` may be multiplied before the loop swings up; 1 where it does so as it is, at most
        MOST."""
        multiples = np.geomspace(1.0, MOST, 1 + round(np.log(MOST) / np.log(FINE))).tolist()
        return next((m for m in multiples if self.growth(gains, m) > GROWS), MOST)

    def growth(self, gains: Gains, multiple: float = 1.0) -> float:
        """1/s: how fast what swings about rest grows with that multiple of the gains; not above 0 where it dies away.

        Friction is left out: it holds a small swing, and not one that has begun.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            trip = self._round_trip(gains, multiple)
        if not np.isfinite(trip).all():  # gains beyond any number
            return float("inf")
        poles = np.linalg.eigvals(trip)
        return float(np.log(max(np.abs(poles).max(), 1e-300)) / self.period)

    def _round_trip(self, gains: Gains, multiple: float) -> Array:
        """One tick of (θ_m, ω_m, θ_l, ω_l, θ_m a tick ago, filtered ω_m, integral, torque on its way)."""
        plant, push = self._plant()
        T, keep = self.period, self.period / (self.filter_time + self.period)
        speed = np.zeros(8)
        speed[[0, 4, 5]] = keep / T, -keep / T, 1.0 - keep
        integral = np.zeros(8)
        integral[[0, 6]] = -multiple * gains.Ki * T, 1.0
        torque = integral - multiple * gains.Kd * speed
        torque[0] -= multiple * gains.Kp
        out = np.zeros((8, 8))
        out[:4, :4], out[:4, 7] = plant, push
        out[4, 0] = 1.0
        out[5], out[6], out[7] = speed, integral, torque
        return out

    def _plant(self) -> tuple[Array, Array]:
        """What a tick makes of the gear's state (4, 4), and of a torque held meanwhile (4,)."""
        from scipy.linalg import expm  # which a program that closes no loop need not load

        d = self.drivetrain
        reduced = d.J_m * d.J_l / (d.J_m + d.J_l)
        k, c = reduced * d.omega_n**2, 2 * d.zeta * d.omega_n * reduced
        rates = np.zeros((5, 5))
        rates[0, 1] = rates[2, 3] = 1.0
        rates[1, :4] = np.array([-k, -c - d.B, k, c]) / d.J_m
        rates[3, :4] = np.array([k, c, -k, -c]) / d.J_l
        rates[1, 4] = 1.0 / d.J_m
        step = expm(rates * self.period)
        return step[:4, :4], step[:4, 4]
