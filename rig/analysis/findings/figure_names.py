"""The figures a run may have: name, unit, procedures that give them, and which may be negative. What a limit can be set
on before the run is made or read; a test holds this table and the analyses in agreement.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Final

from rig.core.kinds import Regime, kinds_of

# `{n}` stands for a number; the unit is the one shown, "1" is none
TURNING: Final = {
    "kinematic_error_peak_to_peak": "arcsec",
    "fourier_amplitude_{n}": "arcsec",
    "fourier_terms": "1",
    "residual_rms": "arcsec",
    "revolutions_forward": "1",
    "revolutions_reverse": "1",
    "direction_offset": "arcsec",
    "trend_slope": "arcsec/deg",
    "trend_peak_to_peak": "arcsec",
    "drift": "arcsec/min",
    "transmission_accuracy": "arcsec",
    "line_{n}": "arcsec",
    "line_order_{n}": "arcsec",
    "flexible_peak_to_peak": "arcsec",
    "flexible_amplitude_{n}": "arcsec",
    "alignment_shift": "°",
    "latch_skew_load": "µs",
    "latch_skew_torque": "µs",
    "latch_skew_error": "arcsec",
    "mean_speed": "rpm",
    "speed_drift": "rpm",
    "speed_ripple": "rpm",
    "speed_scatter": "%",
    "stuck_share": "%",
    "hunting_frequency": "Hz",
    "chosen_speed": "rpm",
    "speed_limit": "rpm",
    "speed_limit_predicted": "rpm",
    "held_frequency": "Hz",
    "highest_order_predicted": "%",
    "mean_motor_torque": "N·m",
    "mean_shaft_torque": "N·m",
    "shaft_torque_swing": "N·m",
    "torsion_remainder_rms": "arcmin",
    "torsion_span": "arcmin",
    "torsional_stiffness_apparent": "N·m/rad",
}
SHOWN_ORDERS: Final = (1, 2, 4, 6, 8, 10)
"""The `fourier_amplitude_{n}` that are figures where they are resolved; all orders stand in the table of a report."""
FRICTION: Final = {
    "coulomb": "N·m",
    "viscous": "N·m·s/rad",
    "fall": "N·m",
    "stribeck_speed": "rpm",
    "motor_coulomb": "N·m",
    "motor_viscous": "N·m·s/rad",
    "motor_fall": "N·m",
    "motor_stribeck_speed": "rpm",
    "load_coulomb": "N·m",
    "load_viscous": "N·m·s/rad",
    "sensor_zero": "N·m",
    "breakaway": "N·m",
    "friction_drift": "%",
}
COAST_DOWN: Final = {
    "inertia_at_motor": "kg·m²",
    "coulomb_torque": "N·m",
    "viscous_friction": "N·m·s/rad",
    "time_constant": "s",
    "holding_torque": "N·m",
    "holding_torque_difference": "N·m",
}
STIFFNESS: Final = {
    "torsional_stiffness": "N·m/rad",
    "torsional_stiffness_gear": "N·m/rad",
    "stiffness_K{n}": "N·m/rad",
    "knot_T{n}": "N·m",
    "cubic_k1": "N·m/rad",
    "cubic_k3": "N·m/rad³",
    "play": "arcmin",
    "lost_motion": "arcmin",
    "hysteresis_loss": "arcmin",
    "hysteresis_energy": "mJ",
    "loop_hysteretic": "N·m",
    "loop_viscous": "N·m·s/rad",
    "creep_per_decade": "%",
    "wave_generator_angle": "°",
}
STANDSTILL: Final = {
    **{f"noise_theta_{side}": "arcsec" for side in "ml"},
    **{f"noise_tau_{side}": "N·m" for side in "ml"},
    **{f"zero_tau_{side}": "N·m" for side in "ml"},
    **{f"drift_theta_{side}": "arcsec/min" for side in "ml"},
    **{f"drift_tau_{side}": "N·m/min" for side in "ml"},
}
CHECK: Final = {"motor_travel": "turns"}

FIGURES: Final = {**TURNING, **FRICTION, **COAST_DOWN, **STIFFNESS, **STANDSTILL, **CHECK}

GIVEN_BY: Final = (
    (TURNING, kinds_of(Regime.SLOW, Regime.AT_SPEED)),
    (FRICTION, ("friction",)),
    (COAST_DOWN, ("coast_down",)),
    (STIFFNESS, kinds_of(Regime.LOCKED)),
    (STANDSTILL, kinds_of(Regime.AT_REST)),
    (CHECK, ()),  # beside what a check found, never for its own sake
)
"""Procedures that are run for the sake of these figures: without them such a run has failed its purpose."""

SIGNED: Final = ("drift", "zero_", "trend_slope", "direction_offset", "alignment_shift", "latch_skew_load",
    "latch_skew_torque", "mean_", "speed_drift", "sensor_zero", "friction_drift", "holding_torque_difference",
    "cubic_k3", "creep_per_decade")  # fmt: skip
"""How the names of those begin that may be below zero; of the others a negative limit says nothing."""


def unit_of(name: str) -> str | None:
    """The unit of the figure `name`; None where no analysis has one of that name."""
    return next((unit for known, unit in FIGURES.items() if re.fullmatch(_pattern(known), name)), None)


def _in(names: Mapping[str, str], name: str) -> bool:
    return any(re.fullmatch(_pattern(known), name) for known in names)


def is_run_for(procedure: str, name: str) -> bool:
    """Whether a run of this procedure is made for the figure `name` among others."""
    return any(procedure in procedures and _in(names, name) for names, procedures in GIVEN_BY)


def figures_of(procedure: str) -> tuple[str, ...]:
    """Names of the figures a run of this procedure is made for; () of one that has none of its own."""
    return tuple(name for names, procedures in GIVEN_BY if procedure in procedures for name in names)


def may_be_negative(name: str) -> bool:
    """Whether the figure `name` has a sign."""
    return name.startswith(SIGNED)


def _pattern(known: str) -> str:
    return re.escape(known).replace(re.escape("{n}"), r"[0-9.]+")
