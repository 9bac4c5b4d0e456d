"""What a campaign covers, which says what of an effect it can show."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

MEASURED: Final = frozenset({"t", "theta_m", "theta_l", "tau_m", "tau_l"})
"""What a full campaign measures."""
SOME: Final = 0.1  # share that the other way, or the other sign, must have


@dataclass(frozen=True)
class Reach:
    """What a campaign covers, from which an effect chooses the shapes worth trying. SI."""

    ratio: float
    fastest: float  # rad/s of the motor
    slowest: float  # rad/s of the motor, while it turns
    torque: float  # N·m, largest |T|
    duration: float  # s, first to last sample of the campaign
    rate: float  # Hz of the samples
    band: float  # Hz up to which the equations are compared
    load_turns: float  # most output turns in one run
    counts_m: float  # encoder counts per turn; 0 when not said
    counts_l: float
    has: frozenset[str] = MEASURED  # channels that any run measured
    runs: int = 30
    slowest_free: float = 1.0  # rad/s of the motor, while it turns and the output is free to; 0 where it never is
    backwards: float = 0.5  # of the rows that turn, share of those that go the way of fewer
    fast_backwards: float = 0.5  # of the squared motor speed, share of the way that has less
    turned_both_ways: float = 1.0  # most output turns in one run the way of which it is less
    pulled: float = 0.5  # of the squared torque, share of that with the sign that has less
    weights: int = 2  # different external torques
    torque_noise: float = 0.0  # N·m, RMS of sensor noise in T, where it is most
    lines_m: tuple[int, ...] = ()  # line counts that the residual shows, whatever is said of the encoders
    lines_l: tuple[int, ...] = ()

    @property
    def both_ways(self) -> bool:
        """Whether the motor turns each way in a fair part of the rows: else a way is but another constant."""
        return self.backwards > SOME

    @property
    def fast_both_ways(self) -> bool:
        """The same of its squared speed."""
        return self.fast_backwards > SOME

    @property
    def pulled_both_ways(self) -> bool:
        """The same of the signs of the squared torque."""
        return self.pulled > SOME

    def speeds_differ(self, times: float) -> bool:
        """Whether the fastest is more than so many times the slowest: at one speed the way is the time."""
        return self.fastest > times * self.slowest
