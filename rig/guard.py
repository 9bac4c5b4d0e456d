"""Limits as pure functions of a sample: None, or a Trip with the reason in words.

Every comparison is written so that NaN trips: a test against a missing number must not pass in silence.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from rig.core.channels import Flag
from rig.core.procedure import Envelope
from rig.core.sample import NAN, Position, Sample, Setpoint, Torque, Velocity
from rig.core.units import DEG, RPM


class Trip(NamedTuple):
    """Why the run must end now."""

    name: str
    sentence: str


@dataclass(frozen=True)
class Limits:
    """The bench's limits, SI, motor side unless said otherwise."""

    speed: float  # rad/s
    torque: float  # N·m, asked or reported
    shaft_torque: float | None  # N·m at the torque sensor; None: the bench has no sensor
    travel: float  # rad, either way from where the run starts
    following: float  # rad, at rest
    following_time: float  # s: allowed lag grows by this long at the reference's speed
    twist: float | None  # rad at the output: |θ_m/N − θ_l| since the start; None: no load encoder
    stale: float  # s


class Guard:
    """The limits for one run, from the bench's limits and what the procedure said it would need."""

    def __init__(self, limits: Limits, envelope: Envelope, ratio: float) -> None:
        self.limits = limits
        self.ratio = ratio
        self.travel = min(limits.travel, 1.02 * envelope.travel + limits.following)
        self.twist = limits.twist if envelope.coupled else None
        # not yet known to follow, or which way: still, the load must not go much farther than the motor may take it
        self.load_travel = None if limits.twist is None else LOAD_MARGIN * self.travel / ratio
        self.torque = min(limits.torque, envelope.torque)
        self.shaft_torque = None if limits.shaft_torque is None else min(limits.shaft_torque, envelope.shaft_torque)
        self.start: Sample | None = None
        self._ranges = {  # middle, how far from it a setpoint may be, what stands in for one that is no number
            Torque: (0.0, self.torque, 0.0),
            Velocity: (0.0, limits.speed, 0.0),
            Position: (NAN, self.travel, NAN),  # from where the run starts: nowhere before that is known
        }

    def check(self, sample: Sample, asked: Setpoint) -> Trip | None:
        """The first limit this sample breaks, in order of how soon it can do harm."""
        start = self.start
        if start is None:
            start = self.start = sample
            self._ranges[Position] = (sample.theta_m, self.travel, NAN)
        lim = self.limits
        _, theta_m, theta_l, omega_m, tau_m, tau_l, age, _, _, _, fault = sample
        ask, theta_ref, omega_ref = asked
        turned, followed = theta_m - start.theta_m, theta_l - start.theta_l
        if (
            not fault
            and age <= lim.stale
            and -lim.speed <= omega_m <= lim.speed
            and -lim.torque * TORQUE_MARGIN <= tau_m <= lim.torque * TORQUE_MARGIN
            and -self.travel <= turned <= self.travel
            and (self.shaft_torque is None or -self.shaft_torque <= tau_l <= self.shaft_torque)
            and (self.twist is None or abs(turned / self.ratio - followed) <= self.twist)
            and (self.load_travel is None or abs(followed) <= self.load_travel)
            and abs(ask) < math.inf
            and not abs(theta_ref - theta_m)
            > lim.following + lim.following_time * abs(omega_ref)  # NaN: no reference, nothing to follow
        ):
            return None
        return next((trip for rule in RULES if (trip := rule(self, sample, asked)) is not None), None)

    def allowed(self, asked: Setpoint) -> Setpoint:
        """The setpoint clipped to what bench and procedure allow: the one place every command passes. What is no number
        becomes no torque, rest, or no new angle, and the next check trips on it.
        """
        kind = type(asked)
        middle, limit, nothing = self._ranges[kind]
        away = asked[0] - middle
        if -limit <= away <= limit:
            return asked
        clipped = middle + math.copysign(limit, away) if away == away else nothing
        return kind(clipped, asked.theta_ref, asked.omega_ref)

    def twist_of(self, sample: Sample) -> float:
        """θ_m/N − θ_l since the start [rad at the output]: what the gear has twisted, slipped, or an encoder lost."""
        start = self.start or sample
        return (sample.theta_m - start.theta_m) / self.ratio - (sample.theta_l - start.theta_l)


WOUND = 0.05  # of the shaft torque allowed: the zero of a sensor and the friction of the load leave less at rest
LOAD_MARGIN = 2.0  # a wrong scale or sign is for the proof to find; a motor encoder that died is for the guard
TORQUE_MARGIN = 1.1  # the drive's torque reading overshoots and is noisy; the command itself is clipped at the limit


def drive_fault(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """The drive's own protection, or what is wrong with another device or a bus: the words say whose."""
    return Trip("drive", f"a device reports a fault: {sample.fault}") if sample.fault else None


def stale(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """Data too old to act on, by the time stamps of the devices."""
    if sample.age <= guard.limits.stale:
        return None
    names = {Flag.STALE_M: "motor", Flag.STALE_L: "load-encoder", Flag.STALE_TAU: "torque-sensor"}
    which = " and ".join(name for flag, name in names.items() if sample.flags & flag) or "usable"
    return Trip(
        "stale", f"no new {which} sample for {sample.age * 1e3:.1f} ms, at most {guard.limits.stale * 1e3:g} ms allowed"
    )


def speed(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """Motor speed."""
    if -guard.limits.speed <= sample.omega_m <= guard.limits.speed:
        return None
    return Trip("speed", f"motor at {sample.omega_m / RPM:.0f} rpm, limit ±{guard.limits.speed / RPM:.0f} rpm")


def torque(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """Motor torque as the drive reports it."""
    limit = guard.limits.torque * TORQUE_MARGIN
    if -limit <= sample.tau_m <= limit:
        return None
    return Trip("torque", f"motor torque {sample.tau_m:.2f} N·m, limit ±{limit:.2f} N·m")


def shaft_torque(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """The torque sensor must not be overloaded."""
    limit = guard.shaft_torque
    if limit is None or -limit <= sample.tau_l <= limit:
        return None
    if sample.tau_l != sample.tau_l:
        return Trip("shaft_torque", f"shaft torque is no number, limit ±{limit:.2f} N·m: is the sensor's cable whole?")
    full = " (sensor at the end of its range)" if sample.flags & Flag.SATURATED_TAU else ""
    return Trip("shaft_torque", f"shaft torque {sample.tau_l:.2f} N·m{full}, limit ±{limit:.2f} N·m")


def travel(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """How far the motor may go from where the run started."""
    moved = sample.theta_m - guard.start.theta_m if guard.start else 0.0
    if -guard.travel <= moved <= guard.travel:
        return None
    return Trip("travel", f"motor {moved / DEG:.1f}° from the start, limit ±{guard.travel / DEG:.1f}°")


def twist(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """Motor and load must agree to within what the gear can twist; when one reading is older than the other, as after a
    stall of the host, by what the motor turns in that time more. How old it may be is the business of `stale`. A
    reading that came in the meantime is new, and may be old all the same: its age is what counts.
    """
    value = guard.twist_of(sample)
    angles = sample.flags & (Flag.STALE_M | Flag.STALE_L) or not sample.flags & Flag.STALE_TAU  # the oldest is one
    apart = max(sample.age, 0.0) if angles else 0.0  # a stamp from ahead of the clock allows no less than a new one
    if guard.twist is None or abs(value) <= guard.twist + apart * abs(sample.omega_m) / guard.ratio:
        return None
    return Trip(
        "twist",
        f"motor and load disagree by {value / DEG:.3f}° at the output since the start, limit ±{guard.twist / DEG:g}°: "
        "an encoder stopped, jumped or lost its coupling, or the gear slipped",
    )


def load_travel(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """What the load encoder says of the travel, when the motor's may be dead."""
    limit = guard.load_travel
    moved = sample.theta_l - guard.start.theta_l if guard.start else 0.0
    if limit is None or abs(moved) <= limit:
        return None
    return Trip(
        "load_travel",
        f"load {moved / DEG:.2f}° from the start, limit ±{limit / DEG:.2f}°: does the motor encoder count, is "
        "load_encoder.counts_per_turn right?",
    )


def asked_number(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """A procedure must ask for a number."""
    if abs(asked[0]) < math.inf:
        return None
    unit, what = {Torque: ("N·m", "torque"), Velocity: ("rad/s", "speed"), Position: ("rad", "angle")}[type(asked)]
    return Trip("asked", f"the procedure asked for {asked[0]} {unit}, expected a finite {what}")


def following(guard: Guard, sample: Sample, asked: Setpoint) -> Trip | None:
    """The motor must stay near its reference; the allowance grows with the reference's speed."""
    error = asked.theta_ref - sample.theta_m
    limit = guard.limits.following + guard.limits.following_time * abs(asked.omega_ref)
    if not abs(error) > limit:
        return None
    way = error * asked.omega_ref
    where = "behind" if way > 0 else "ahead of" if way < 0 else "off"
    return Trip(
        "following",
        f"motor {abs(error) / DEG:.1f}° {where} its reference, limit ±{limit / DEG:.1f}° at this speed: "
        "the gains are too weak or too strong (hdrig tune finds better ones), or something holds the motor",
    )


Rule = Callable[[Guard, Sample, Setpoint], Trip | None]
RULES: tuple[Rule, ...] = (
    drive_fault,
    stale,
    speed,
    torque,
    shaft_torque,
    travel,
    load_travel,
    twist,
    asked_number,
    following,
)
