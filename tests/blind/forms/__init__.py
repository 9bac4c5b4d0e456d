"""The catalogue: every effect name of trace-report.md with its forms, and the effects outside of it."""

from tests.blind.forms import (
    angle_dependent_stiffness,
    channel_time_skew,
    cogging_torque,
    encoder_interpolation_error,
    external_vibration,
    flexspline_frame_error,
    gravity_unbalance,
    hysteretic_stiffness,
    load_dependent_friction,
    load_dependent_kinematic_error,
    lost_motion,
    missed_counts,
    motor_encoder_eccentricity,
    nonlinear_stiffness,
    output_once_per_rev,
    position_dependent_friction,
    presliding_friction,
    quadratic_drag,
    stribeck_friction,
    support_compliance,
    thermal_friction_drift,
    tooth_mesh_error,
    torque_ripple,
    torque_sensor_crosstalk,
    torsional_mode,
)
from tests.blind.forms.form import Form
from tests.blind.forms.outside import OUTSIDE

LIBRARY: tuple[Form, ...] = (
    *angle_dependent_stiffness.FORMS,
    *channel_time_skew.FORMS,
    *cogging_torque.FORMS,
    *encoder_interpolation_error.FORMS,
    *external_vibration.FORMS,
    *flexspline_frame_error.FORMS,
    *gravity_unbalance.FORMS,
    *hysteretic_stiffness.FORMS,
    *load_dependent_friction.FORMS,
    *load_dependent_kinematic_error.FORMS,
    *lost_motion.FORMS,
    *missed_counts.FORMS,
    *motor_encoder_eccentricity.FORMS,
    *nonlinear_stiffness.FORMS,
    *output_once_per_rev.FORMS,
    *position_dependent_friction.FORMS,
    *presliding_friction.FORMS,
    *quadratic_drag.FORMS,
    *stribeck_friction.FORMS,
    *support_compliance.FORMS,
    *thermal_friction_drift.FORMS,
    *tooth_mesh_error.FORMS,
    *torque_ripple.FORMS,
    *torque_sensor_crosstalk.FORMS,
    *torsional_mode.FORMS,
)
EFFECTS = tuple(dict.fromkeys(form.effect for form in LIBRARY))


def forms_of(effect: str) -> tuple[Form, ...]:
    """Forms of one effect; an unknown name is refused with the names there are."""
    found = tuple(form for form in (*LIBRARY, *OUTSIDE) if form.effect == effect)
    if not found:
        names = ", ".join((*EFFECTS, *(form.effect for form in OUTSIDE)))
        raise ValueError(f"no effect called '{effect}': there are {names}")
    return found


def form_of(effect: str, name: str) -> Form:
    for form in forms_of(effect):
        if form.name == name:
            return form
    raise ValueError(f"{effect} has no form '{name}': there are {', '.join(f.name for f in forms_of(effect))}")


__all__ = ["EFFECTS", "LIBRARY", "OUTSIDE", "Form", "form_of", "forms_of"]
