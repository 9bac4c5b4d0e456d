"""What the twin is made of, as one value. Every number comes from the bench file; none has a default here."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields

from rig.core.errors import UsageError
from rig.model.gear import Gear
from sim.effects import Effects

POSITIVE = {
    *("ratio", "J_m", "J_l", "K", "omega_s"),
    *("friction_noise_s", "torque_limit", "watchdog", "motor_counts_per_turn", "load_counts_per_turn"),
    *("sensor_range", "sensor_lowpass_hz"),
}
ANY = {"gear", "kinematic_error", "sensor_zero", "sigma", "effects"}  # no numbers, or of either sign


@dataclass(frozen=True)
class TwinParameters:
    """The gear with its friction, the drive, the sensors. Raises UsageError when no such rig can exist."""

    gear: Gear
    friction_noise: float  # 1, slow wander of both friction torques, 1 sigma, relative
    friction_noise_s: float  # s, correlation time of that wander
    tau_drive: float  # s, time constant of the drive's torque loop
    torque_limit: float  # N·m, the drive gives no more
    torque_resolution: float  # N·m, of commanded and of reported motor torque
    torque_noise: float  # N·m, of the reported motor torque, 1 sigma
    watchdog: float  # s without a command before the drive lets go
    motor_counts_per_turn: int
    load_counts_per_turn: int
    sensor_range: float  # N·m, either way
    sensor_noise: float  # N·m, 1 sigma of one reading
    sensor_zero: float  # N·m, zero offset
    sensor_lowpass_hz: float  # Hz, first-order corner
    sensor_resolution: float  # N·m
    latch_m: float  # s after the tick
    latch_l: float  # s after the tick
    latch_tau: float  # s after the tick
    effects: Effects = field(default_factory=Effects)  # what the paper's model lacks

    def __post_init__(self) -> None:
        for part in (self, self.gear):
            for entry in fields(part):
                if entry.name not in ANY:
                    _check(entry.name, getattr(part, entry.name))
        if self.effects.friction.presliding > self.gear.tau_c:
            raise UsageError(
                f"the twin's presliding is {self.effects.friction.presliding:g} N·m, "
                f"expected no more than its Coulomb friction tau_c of {self.gear.tau_c:g} N·m"
            )
        if self.gear.tau_s < self.gear.tau_c:
            raise UsageError(
                f"the twin's breakaway torque tau_s is {self.gear.tau_s:g} N·m, "
                f"expected at least its Coulomb friction tau_c of {self.gear.tau_c:g} N·m"
            )


def _check(name: str, value: float) -> None:
    if not math.isfinite(value) or value < 0.0 or (value == 0.0 and name in POSITIVE):
        expected = "more than 0" if name in POSITIVE else "0 or more"
        raise UsageError(f"the twin's {name} is {value!r}, expected a finite number, {expected}")
