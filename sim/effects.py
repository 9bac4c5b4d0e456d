"""What the twin has and the paper's model lacks, as one value. Every effect is off unless its number says otherwise.

The bench file's [twin.effects] has the same sections and keys. Angles in degrees carry `_deg`, at the shaft they belong
to; orders are cycles per turn of that shaft. Laws and sizes: `sim/kernel`, `sim/encoder.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, get_type_hints


@dataclass(frozen=True)
class Stiffness:
    """The spring's law beside τ = K·φ: K1 is the gear's K."""

    cubic: float = 0.0  # N·m/rad³, τ = K·φ + cubic·φ³
    T1: float = 0.0  # N·m, the soft wind-up ends; 0: one straight line
    T2: float = 0.0  # N·m
    K2: float = 0.0  # N·m/rad, from T1 to T2
    K3: float = 0.0  # N·m/rad, above T2
    by_angle: float = 0.0  # 1, share of K that comes and goes with the wave generator's angle
    by_angle_order: float = 2.0
    by_angle_deg: float = 0.0  # where it is stiffest, deg of its own order
    gap_deg: float = 0.0  # half the dead zone, at the output


@dataclass(frozen=True)
class Hysteresis:
    """Maxwell elements in parallel that slip one after the other, evenly spaced, all of one stiffness."""

    torque: float = 0.0  # N·m, half the width of the full loop
    twist_deg: float = 0.06  # at the output, where the last one slips
    elements: int = 4


@dataclass(frozen=True)
class Creep:
    """Two spring-and-dashpot elements in parallel with the spring; a held torque winds on by stiffness/K."""

    stiffness_1: float = 0.0  # N·m/rad
    time_1: float = 3.0  # s, relaxation
    stiffness_2: float = 0.0  # N·m/rad
    time_2: float = 60.0  # s


@dataclass(frozen=True)
class LoadDependentError:
    """Kinematic error by load: (A_∞ + (A_0 − A_∞)·exp(−T̄/T_c))·(Eq. 8), A_0 = 1 at the reference depth."""

    A_inf: float = 1.0  # 1, share left under high load
    T_c: float = 2.5  # N·m
    filter: float = 5.0  # s, low-pass that makes T̄ of the size of the spring's torque


@dataclass(frozen=True)
class Assembly:
    """What assembly changes: the wave generator's depth, and a little of everything by chance."""

    depth_mm: float = 0.0  # mm, from the reference depth
    error_per_mm: float = 0.0  # 1/mm, A_0 falls by this share
    friction_per_mm: float = 0.0  # 1/mm, friction of the motor side rises by this share
    scatter: float = 0.0  # 1, 1 sigma of each order's amplitude from assembly to assembly
    scatter_deg: float = 0.0  # 1 sigma of each order's phase, deg of its own order


@dataclass(frozen=True)
class ErrorLines:
    """Orders of the kinematic error outside of Eq. 8, amplitudes at the output. They do not shrink with load."""

    flexspline_deg: float = 0.0  # order 2·(1 + 1/N): rides on the flexspline
    flexspline_phase_deg: float = 0.0
    flexspline_second_deg: float = 0.0  # order 4·(1 + 1/N)
    flexspline_second_phase_deg: float = 0.0
    tooth_mesh_deg: float = 0.0  # order 2·(N + 1): the teeth of the circular spline
    tooth_mesh_phase_deg: float = 0.0
    output_deg: float = 0.0  # once per output turn
    output_phase_deg: float = 0.0
    output_second_deg: float = 0.0  # twice per output turn
    output_second_phase_deg: float = 0.0


@dataclass(frozen=True)
class Friction:
    """Friction of the motor side beyond Stribeck's curve."""

    presliding: float = 0.0  # N·m, part of τ_c that gives way like bristles before it slides
    presliding_deg: float = 0.1  # at the motor, where the last of them slips
    presliding_elements: int = 4
    by_load: float = 0.0  # 1, μ: share of the transmitted torque, at the motor μ·T/N
    by_angle: float = 0.0  # 1, share that comes and goes with the wave generator's angle
    by_angle_order: float = 2.0
    by_angle_deg: float = 0.0
    quadratic_drag: float = 0.0  # N·m·s²/rad²
    two_thirds_drag: float = 0.0  # N·m·(s/rad)^(2/3)
    thermal_beta: float = 0.0  # 1/K, friction and drag fall as exp(−β·warmth)
    thermal_rise: float = 0.0  # K/W
    thermal_time: float = 1500.0  # s


@dataclass(frozen=True)
class Motor:
    """Torque of the motor that was not asked for."""

    cogging: float = 0.0  # N·m
    cogging_order: float = 24.0
    cogging_phase_deg: float = 0.0
    ripple: float = 0.0  # 1, share of the torque asked
    ripple_order: float = 8.0
    ripple_phase_deg: float = 0.0


@dataclass(frozen=True)
class Load:
    """Torque on the load."""

    unbalance: float = 0.0  # N·m, −unbalance·sin(θ_l − phase)
    unbalance_phase_deg: float = 0.0
    vibration: float = 0.0  # N·m, at a fixed frequency
    vibration_hz: float = 50.0
    vibration_phase_deg: float = 0.0


@dataclass(frozen=True)
class Sensors:
    """What the sensors add to what is there."""

    motor_eccentricity_deg: float = 0.0  # once per turn, at the motor
    motor_eccentricity_phase_deg: float = 0.0
    motor_interpolation_deg: float = 0.0  # once per line, at the motor
    motor_lines: int = 2500
    motor_skew: float = 0.0  # s, latched later than the reading says
    load_eccentricity_deg: float = 0.0  # once per turn, at the output
    load_eccentricity_phase_deg: float = 0.0
    load_ellipticity_deg: float = 0.0  # twice per turn
    load_ellipticity_phase_deg: float = 0.0
    load_interpolation_deg: float = 0.0  # once per line, at the output
    load_lines: int = 225000
    load_skew: float = 0.0  # s
    torque_skew: float = 0.0  # s
    crosstalk: float = 0.0  # N·m, once per output turn, in the torque sensor alone
    crosstalk_phase_deg: float = 0.0
    crosstalk_second: float = 0.0  # N·m, twice per output turn
    crosstalk_second_phase_deg: float = 0.0
    zero_drift: float = 0.0  # N·m, where the zero ends
    zero_drift_time: float = 1200.0  # s, first order
    pickup: float = 0.0  # N·m, at a fixed frequency
    pickup_hz: float = 50.0


@dataclass(frozen=True)
class Effects:
    """All of them."""

    stiffness: Stiffness = field(default_factory=Stiffness)
    hysteresis: Hysteresis = field(default_factory=Hysteresis)
    creep: Creep = field(default_factory=Creep)
    load_dependent_error: LoadDependentError = field(default_factory=LoadDependentError)
    assembly: Assembly = field(default_factory=Assembly)
    error_lines: ErrorLines = field(default_factory=ErrorLines)
    friction: Friction = field(default_factory=Friction)
    motor: Motor = field(default_factory=Motor)
    load: Load = field(default_factory=Load)
    sensors: Sensors = field(default_factory=Sensors)

    @classmethod
    def of(cls, sections: Mapping[str, Mapping[str, Any]]) -> Effects:
        """As the sections of a bench file say. Raises KeyError or TypeError for what is no effect."""
        kinds = get_type_hints(cls)
        return cls(**{name: kinds[name](**numbers) for name, numbers in sections.items()})

    @property
    def in_the_plant(self) -> bool:
        """Whether the plant itself has any of them."""
        s, f = self.stiffness, self.friction
        sizes = (
            *(s.cubic, s.T1, s.by_angle, s.gap_deg, self.hysteresis.torque),
            *(self.creep.stiffness_1, self.creep.stiffness_2, 1.0 - self.load_dependent_error.A_inf),
            *(self.assembly.depth_mm * self.assembly.error_per_mm,),
            *(f.presliding, f.by_load, f.by_angle, f.quadratic_drag, f.two_thirds_drag, f.thermal_beta),
            *(self.motor.cogging, self.motor.ripple, self.load.unbalance, self.load.vibration),
            *(amplitude for _, amplitude, _ in lines(self.error_lines, 1.0, 1)),
        )
        return any(size != 0.0 for size in sizes)


def lines(e: ErrorLines, ratio: float, sigma: int) -> list[tuple[float, float, float]]:
    """(order per motor turn, amplitude [deg], phase [deg]) of the lines that are there, orders by the gear's frame."""
    riding = 1.0 + 1.0 / ratio if sigma == 1 else 1.0 - 1.0 / ratio  # the spline that turns, seen by the wave generator
    teeth = 2.0 * (ratio + 1.0) if sigma == 1 else 2.0 * ratio
    table = (
        (2.0 * riding, e.flexspline_deg, e.flexspline_phase_deg),
        (4.0 * riding, e.flexspline_second_deg, e.flexspline_second_phase_deg),
        (teeth, e.tooth_mesh_deg, e.tooth_mesh_phase_deg),
        (1.0 / ratio, e.output_deg, e.output_phase_deg),
        (2.0 / ratio, e.output_second_deg, e.output_second_phase_deg),
    )
    return [row for row in table if row[1] != 0.0]
