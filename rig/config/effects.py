"""[twin.effects]: what the twin has and the paper's model lacks. What a file does not name is off."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from rig.config.quantities import NotNegative, Positive, Strict, quantity

FINITE = {"allow_inf_nan": False}
SHARE = {"ge": 0, "lt": 1, "allow_inf_nan": False}
Angle = Annotated[float, quantity("deg", **FINITE)]
Amplitude = Annotated[float, quantity("deg", ge=0, le=1)]  # of an error; a whole degree is no small one
Torque = Annotated[float, quantity("N·m", **NotNegative)]
Share = Annotated[float, quantity("1", **SHARE)]
Order = Annotated[float, quantity("1", gt=0, le=1000)]
Stiffness = Annotated[float, quantity("N·m/rad", **NotNegative)]
Span = Annotated[float, quantity("s", **Positive)]
Skew = Annotated[float, quantity("s", ge=-0.005, le=0.005)]  # of a tick: extrapolated from there
Hertz = Annotated[float, quantity("Hz", gt=0, le=1000)]


class StiffnessSection(Strict):
    """[twin.effects.stiffness]"""

    cubic: Annotated[float, quantity("N·m/rad³", **NotNegative)] = 0.0
    T1: Torque = 0.0
    T2: Torque = 0.0
    K2: Stiffness = 0.0
    K3: Stiffness = 0.0
    by_angle: Share = 0.0
    by_angle_order: Order = 2.0
    by_angle_deg: Angle = 0.0
    gap_deg: Amplitude = 0.0

    @model_validator(mode="after")
    def _pieces(self) -> StiffnessSection:
        if self.T1 > 0.0 and not (self.T2 >= self.T1 and self.K2 > 0.0 and self.K3 > 0.0):
            raise ValueError(
                f"a spring of pieces (T1 = {self.T1:g} N·m) has T2 = {self.T2:g} N·m, K2 = {self.K2:g} N·m/rad, "
                f"K3 = {self.K3:g} N·m/rad: expected T2 of at least T1, K2 and K3 above 0"
            )
        return self


class HysteresisSection(Strict):
    """[twin.effects.hysteresis]"""

    torque: Torque = 0.0
    twist_deg: Annotated[float, quantity("deg", **Positive)] = 0.06
    elements: Annotated[int, quantity("1", ge=1, le=32)] = 4


class CreepSection(Strict):
    """[twin.effects.creep]"""

    stiffness_1: Stiffness = 0.0
    time_1: Span = 3.0
    stiffness_2: Stiffness = 0.0
    time_2: Span = 60.0


class LoadDependentErrorSection(Strict):
    """[twin.effects.load_dependent_error]"""

    A_inf: Annotated[float, quantity("1", ge=0, le=1)] = 1.0
    T_c: Annotated[float, quantity("N·m", **Positive)] = 2.5
    filter: Annotated[float, quantity("s", ge=0.01, le=1000)] = 5.0


class AssemblySection(Strict):
    """[twin.effects.assembly]"""

    depth_mm: Annotated[float, quantity("mm", ge=-2, le=2)] = 0.0
    error_per_mm: Annotated[float, quantity("1/mm", **NotNegative)] = 0.0
    friction_per_mm: Annotated[float, quantity("1/mm", ge=0, le=0.49)] = 0.0  # friction stays above 0 at −2 mm
    scatter: Share = 0.0
    scatter_deg: Annotated[float, quantity("deg", ge=0, le=180)] = 0.0


class ErrorLinesSection(Strict):
    """[twin.effects.error_lines]"""

    flexspline_deg: Amplitude = 0.0
    flexspline_phase_deg: Angle = 0.0
    flexspline_second_deg: Amplitude = 0.0
    flexspline_second_phase_deg: Angle = 0.0
    tooth_mesh_deg: Amplitude = 0.0
    tooth_mesh_phase_deg: Angle = 0.0
    output_deg: Amplitude = 0.0
    output_phase_deg: Angle = 0.0
    output_second_deg: Amplitude = 0.0
    output_second_phase_deg: Angle = 0.0


class FrictionSection(Strict):
    """[twin.effects.friction]"""

    presliding: Torque = 0.0
    presliding_deg: Annotated[float, quantity("deg", **Positive)] = 0.1
    presliding_elements: Annotated[int, quantity("1", ge=1, le=32)] = 4
    by_load: Share = 0.0
    by_angle: Share = 0.0
    by_angle_order: Order = 2.0
    by_angle_deg: Angle = 0.0
    quadratic_drag: Annotated[float, quantity("N·m·s²/rad²", **NotNegative)] = 0.0
    two_thirds_drag: Annotated[float, quantity("N·m·(s/rad)^(2/3)", **NotNegative)] = 0.0
    thermal_beta: Annotated[float, quantity("1/K", ge=0, le=1)] = 0.0
    thermal_rise: Annotated[float, quantity("K/W", **NotNegative)] = 0.0
    thermal_time: Span = 1500.0


class MotorEffectsSection(Strict):
    """[twin.effects.motor]"""

    cogging: Torque = 0.0
    cogging_order: Order = 24.0
    cogging_phase_deg: Angle = 0.0
    ripple: Share = 0.0
    ripple_order: Order = 8.0
    ripple_phase_deg: Angle = 0.0


class LoadEffectsSection(Strict):
    """[twin.effects.load]"""

    unbalance: Torque = 0.0
    unbalance_phase_deg: Angle = 0.0
    vibration: Torque = 0.0
    vibration_hz: Hertz = 50.0
    vibration_phase_deg: Angle = 0.0


class SensorEffectsSection(Strict):
    """[twin.effects.sensors]"""

    motor_eccentricity_deg: Amplitude = 0.0
    motor_eccentricity_phase_deg: Angle = 0.0
    motor_interpolation_deg: Amplitude = 0.0
    motor_lines: Annotated[int, quantity("1", ge=1, le=2**30)] = 2500
    motor_skew: Skew = 0.0
    load_eccentricity_deg: Amplitude = 0.0
    load_eccentricity_phase_deg: Angle = 0.0
    load_ellipticity_deg: Amplitude = 0.0
    load_ellipticity_phase_deg: Angle = 0.0
    load_interpolation_deg: Amplitude = 0.0
    load_lines: Annotated[int, quantity("1", ge=1, le=2**30)] = 225000
    load_skew: Skew = 0.0
    torque_skew: Skew = 0.0
    crosstalk: Torque = 0.0
    crosstalk_phase_deg: Angle = 0.0
    crosstalk_second: Torque = 0.0
    crosstalk_second_phase_deg: Angle = 0.0
    zero_drift: Annotated[float, quantity("N·m", **FINITE)] = 0.0
    zero_drift_time: Span = 1200.0
    pickup: Torque = 0.0
    pickup_hz: Hertz = 50.0


class EffectsSection(Strict):
    """[twin.effects]"""

    stiffness: StiffnessSection = StiffnessSection()
    hysteresis: HysteresisSection = HysteresisSection()
    creep: CreepSection = CreepSection()
    load_dependent_error: LoadDependentErrorSection = LoadDependentErrorSection()
    assembly: AssemblySection = AssemblySection()
    error_lines: ErrorLinesSection = ErrorLinesSection()
    friction: FrictionSection = FrictionSection()
    motor: MotorEffectsSection = MotorEffectsSection()
    load: LoadEffectsSection = LoadEffectsSection()
    sensors: SensorEffectsSection = SensorEffectsSection()
