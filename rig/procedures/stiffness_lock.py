"""The lock test: output locked, the motor winds the gear up one way and the other under the torque sensor's eye."""

from __future__ import annotations

import math
from collections.abc import Generator
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from rig.control.winding import Winding, answers_at, stiffest
from rig.core.errors import NotReady, UsageError
from rig.core.procedure import Envelope, Procedure, Setting, Steps
from rig.core.sample import Sample, Setpoint, Torque
from rig.core.units import DEG

SOFTEST = 3.0  # times the declared compliance: a gear that winds up farther is not the one of the bench file
GIVES_WAY = 0.15  # of the wind-up at tau_max: a load that moved this far is not locked
OVERSHOOT = 1.3  # of tau_max: a slip may end beyond it by what stick-slip is long
OVERSHOOT_BY = 3.0  # N·m, and so much more, whatever the torque: what a slip of a motor that sticks may add
PATIENCE = 3.0  # times what unwinding should take: a gear that still shows torque then is let go, and it is said
SLIP = 2.5  # N·m that the last slip of the motor may leave in the shaft
LITTLE = 1.0  # N·m: to turn the motor for less would only slip to the other side
AT_REST = 0.5  # s with the reference at rest, before the first ramp and after unwinding

Part = Generator[Setpoint, Sample, Sample]
"""Steps that end with the newest sample."""


class WoundUp(NamedTuple):
    """What the procedure itself saw."""

    stiffness: float  # N·m/rad, secant of the last whole ramp
    left: float  # N·m at the shaft when the torque was taken off
    sentence: str


class Unwound(NamedTuple):
    """A gear let out."""

    before: float  # N·m at the shaft
    after: float
    sentence: str


@dataclass(frozen=True)
class StiffnessLock(Procedure):
    """Wind the locked gear up and down: 0 → +tau_max → −tau_max → 0, held at both ends      [ghorbel2001, App. B]

    The motor is under its position loop; a ramp ends when the shaft torque gets there. `cycles` are made at the first
    of `rates`, one more at each of the others: a loop that widens with the rate is viscous, one that does not is
    hysteresis. The wave generator turns a few degrees only, so this is the stiffness at one angle of it; another angle
    is another run, with the output freed between.
    """

    name: ClassVar[str] = "stiffness_lock"
    needs: ClassVar[tuple[str, ...]] = ("theta_m", "theta_l", "tau_l")
    output_locked: ClassVar[bool] = True

    tau_max: float = 15.0  # N·m at the torque sensor
    rate: float = 0.75  # N·m/s at the torque sensor: 20 s a quarter
    cycles: int = 3  # at the first of `rates`
    hold: float = 2.0  # s at the ends, for creep
    rates: tuple[float, ...] = (1.0, 0.3, 3.0)  # of `rate`; spans a factor of ten
    unwind_rate: float = 5.0  # N·m/s, when it was stopped
    gain: float = 4.0  # of the position loop over the bench's K_p: stick-slip gets as much finer

    def __post_init__(self) -> None:
        if self.cycles < 1:
            raise UsageError(f"cycles = {self.cycles}: expected at least 1")
        if not self.rates or not all(0.01 <= r <= 100 for r in self.rates):
            raise UsageError(f"rates = {list(self.rates)}: expected shares of the rate, each from 0.01 to 100")

    @property
    def ramps(self) -> list[tuple[float, float]]:
        """(torque to reach N·m, rate N·m/s), one after the other; the last lets everything out."""
        out = []
        for k, share in enumerate(self.rates):
            for _ in range(self.cycles if k == 0 else 1):
                out += [(self.tau_max, share * self.rate), (-self.tau_max, share * self.rate)]
        return [*out, (0.0, self.rates[0] * self.rate)]

    def wind_up(self, setting: Setting) -> float:
        """Of the motor at tau_max, from the declared stiffness [rad]."""
        return setting.ratio * self.tau_max / setting.stiffness

    def envelope(self, setting: Setting) -> Envelope:
        """Only the first ramp relies on the declared stiffness; later ones know what they measured."""
        torques = [0.0, *(torque for torque, _ in self.ramps)]
        times = [abs(b - a) / r for a, (b, r) in zip(torques, self.ramps, strict=False)]
        duration = SOFTEST * times[0] + 1.5 * sum(times[1:]) + self.hold * len(times) + 2 * AT_REST
        fastest = max(self.rate * max(self.rates), self.unwind_rate)
        return Envelope(
            duration,
            travel=SOFTEST * self.wind_up(setting),
            speed=self.wind_up(setting) * fastest / self.tau_max,
            torque=setting.control.torque_limit,
            shaft_torque=OVERSHOOT * self.tau_max + OVERSHOOT_BY,
            loop=answers_at(setting, self.gain),
            loop_by=f"gain = {self.gain:g} times K_p, at most {stiffest(setting):.3g} times here",
            reserve=(
                f"tau_max = {self.tau_max:g} N·m, and {100 * (OVERSHOOT - 1):.0f} % and {OVERSHOOT_BY:g} N·m more "
                "that a slip of the motor may wind it up by"
            ),
        )

    def conditions(self) -> dict[str, Any]:
        """For the manifest."""
        return {"output_locked": True, "tau_max": self.tau_max, "torque_rates": [r * self.rate for r in self.rates]}

    def remarks(self, setting: Setting) -> list[str]:
        """Stored energy and how it is let out."""
        motor, energy = self.wind_up(setting), 0.5 * self.tau_max**2 / setting.stiffness
        return [
            f"±{self.tau_max:g} N·m wind the locked gear up by ±{motor / setting.ratio / DEG:.3f}° at the output "
            f"(±{motor / DEG:.1f}° of the motor) and store {energy:.3f} J, at the declared "
            f"{setting.stiffness:g} N·m/rad",
            f"a stop unwinds it at {self.unwind_rate:g} N·m/s, {self.tau_max / self.unwind_rate:.1f} s at most; "
            f"a second one, or a trip, lets go at once, and friction may then hold up to {self.tau_max:g} N·m",
        ]

    def steps(self, setting: Setting) -> Steps:
        """Returns a WoundUp. Raises NotReady, unwound first, when the output is not locked or the gear too soft."""
        sample = yield Torque(0.0)
        start, winding, stiffness = sample, Winding(setting, self.gain, sample), setting.stiffness
        begin_angle = sample.theta_m % (2 * math.pi) / DEG
        setting.note(f"wave generator at {begin_angle:.2f}° of its encoder, shaft torque {sample.tau_l:+.2f} N·m")
        sample = yield from self._stay(winding, sample, AT_REST)
        for torque, rate in self.ramps:
            before, from_torque = sample, winding.torque
            sample = yield from self._ramp(setting, winding, sample, start, torque, setting.ratio * rate / stiffness)
            turned = abs(sample.theta_m - before.theta_m) / setting.ratio
            if torque and turned > 0:
                stiffness = abs(winding.torque - from_torque) / turned
            sample = yield from self._stay(winding, sample, self.hold if torque else AT_REST)
        left = winding.torque
        told = f"last whole ramp {stiffness:.0f} N·m/rad (secant); unwound to {left:+.2f} N·m, torque off"
        return WoundUp(stiffness, left, told)

    def to_rest(self, setting: Setting) -> Steps:
        """Unwind along a ramp until the shaft shows next to no torque: neither held nor let go. Returns an Unwound."""
        sample = yield Torque(0.0)
        winding = Winding(setting, self.gain, sample)
        wound = winding.torque
        if abs(wound) <= LITTLE:
            told = f"the shaft shows {wound:+.2f} N·m, not more than {LITTLE:g} N·m: nothing was turned"
            setting.note(told)
            return Unwound(wound, wound, told)
        yield from self._unwind(setting, winding, sample)
        told = f"unwound from {wound:+.2f} to {winding.torque:+.2f} N·m"
        setting.note(told)
        return Unwound(wound, winding.torque, told)

    def _unwind(self, setting: Setting, winding: Winding, sample: Sample) -> Part:
        direction, begin = -math.copysign(1.0, winding.torque), sample.t
        patience = PATIENCE * abs(winding.torque) / self.unwind_rate + AT_REST
        omega = direction * setting.ratio * self.unwind_rate / setting.stiffness
        while direction * winding.torque < -LITTLE and sample.t - begin < patience:
            sample = yield winding.step(sample, omega)
        return (yield from self._stay(winding, sample, AT_REST))

    def _stay(self, winding: Winding, sample: Sample, duration: float) -> Part:
        winding.stay(sample)
        begin = sample.t
        while sample.t - begin < duration:
            sample = yield winding.step(sample, 0.0)
        return sample

    def _ramp(
        self, setting: Setting, winding: Winding, sample: Sample, start: Sample, torque: float, omega: float
    ) -> Part:
        """Turn at `omega` rad/s until the shaft torque reaches `torque` N·m; the output must stay where it is."""
        direction = 1.0 if torque > winding.torque else -1.0
        while direction * (torque - winding.torque) > 0:
            refusal = self._gives_way(setting, sample, start) or self._too_soft(setting, sample, start)
            if refusal:
                yield from self._unwind(setting, winding, sample)
                raise NotReady(refusal)
            sample = yield winding.step(sample, direction * omega)
        return sample

    def _gives_way(self, setting: Setting, sample: Sample, start: Sample) -> str:
        """Why the output is not locked; "" while it is."""
        load, motor = sample.theta_l - start.theta_l, (sample.theta_m - start.theta_m) / setting.ratio
        if abs(load) <= GIVES_WAY * self.wind_up(setting) / setting.ratio:
            return ""
        return (
            f"the load turned by {load / DEG:+.4f}° while the motor turned by {motor / DEG:+.4f}° at the output "
            f"({100 * load / motor if motor else math.nan:.0f} %), shaft torque {sample.tau_l:+.2f} N·m: "
            "the output is not locked, or its lock gives way"
        )

    def _too_soft(self, setting: Setting, sample: Sample, start: Sample) -> str:
        """Why the wind-up is more than this gear can need; "" while it is not."""
        motor = sample.theta_m - start.theta_m
        if abs(motor) <= SOFTEST * self.wind_up(setting):
            return ""
        expected = self.wind_up(setting) / setting.ratio / DEG
        return (
            f"wound up by {motor / setting.ratio / DEG:+.3f}° at the output the shaft torque is "
            f"{sample.tau_l:+.2f} N·m, expected ±{self.tau_max:g} N·m at {expected:.3f}°: "
            "is the declared stiffness right, does the torque sensor lie between gear and lock?"
        )
