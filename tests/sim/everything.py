"""A twin with all of it switched on at once, each somewhat larger than a rig would have it."""

from __future__ import annotations

from sim.effects import (
    Assembly,
    Creep,
    Effects,
    ErrorLines,
    Friction,
    Hysteresis,
    Load,
    LoadDependentError,
    Motor,
    Stiffness,
)

EVERYTHING = Effects(
    stiffness=Stiffness(
        cubic=2.3e8, T1=3.0, T2=8.0, K2=9000.0, K3=11000.0, by_angle=0.05, by_angle_deg=20.0, gap_deg=0.002
    ),
    hysteresis=Hysteresis(torque=0.6),
    creep=Creep(stiffness_1=200.0, stiffness_2=150.0),
    load_dependent_error=LoadDependentError(A_inf=0.55, T_c=2.5, filter=0.3),
    assembly=Assembly(depth_mm=0.2, error_per_mm=0.5, friction_per_mm=0.5),
    error_lines=ErrorLines(
        flexspline_deg=0.003,
        flexspline_phase_deg=40.0,
        flexspline_second_deg=0.001,
        tooth_mesh_deg=0.0003,
        output_deg=0.004,
        output_second_deg=0.002,
        output_second_phase_deg=-70.0,
    ),
    friction=Friction(
        presliding=0.2,
        by_load=0.25,
        by_angle=0.1,
        by_angle_deg=30.0,
        quadratic_drag=2e-5,
        two_thirds_drag=0.01,
        thermal_beta=0.03,
        thermal_rise=5.0,
        thermal_time=10.0,
    ),
    motor=Motor(cogging=0.04, cogging_phase_deg=10.0, ripple=0.02, ripple_phase_deg=-50.0),
    load=Load(unbalance=0.5, unbalance_phase_deg=25.0, vibration=0.3, vibration_phase_deg=60.0),
)
SECTIONS = tuple(name for name in vars(EVERYTHING) if name not in ("assembly", "sensors"))


def only(section: str) -> Effects:
    """One section of it, all else off."""
    return Effects(**{section: getattr(EVERYTHING, section)})
