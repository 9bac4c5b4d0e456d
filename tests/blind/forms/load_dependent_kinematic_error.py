"""Kinematic error that shrinks with load [physics C1]: exponential (textbook), rational, unequal orders, straight."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, LOAD, Builder
from tests.blind.forms.form import Form, Parameters, pick


def exponential(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    lost, torque = min(pick(rng, 0.3, 0.5) * strength, 0.9), pick(rng, 1.5, 4.0)
    builder.add("p_load", builder.pure_error())
    builder.add("ke_gain", lost * np.expm1(-LOAD / torque))
    return {"A_inf": 1 - lost, "torque_scale_Nm": torque}


def rational(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    lost, torque = min(pick(rng, 0.3, 0.5) * strength, 0.9), pick(rng, 2.0, 5.0)
    ratio = (LOAD / torque) ** 2
    builder.add("p_load", builder.pure_error())
    builder.add("ke_gain", -lost * ratio / (1 + ratio))
    return {"A_inf": 1 - lost, "torque_scale_Nm": torque}


def unequal_orders(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Orders one and two shrink, the fourth less, the others stay; logistic in the torque."""
    lost, torque = min(pick(rng, 0.35, 0.6) * strength, 0.9), pick(rng, 2.0, 5.0)
    rig, part = builder.rig, np.zeros_like(ANGLE)
    for order, weight in ((1, 1.0), (2, 1.0), (4, 0.5)):
        a, b = rig.ke_cos[order - 1], rig.ke_sin[order - 1]
        part = part + weight * (a * np.cos(order * ANGLE) + b * np.sin(order * ANGLE))
    builder.add("p_load", part)
    builder.add("ke_gain", -lost * np.tanh(LOAD / torque))
    return {"A_inf_order_2": 1 - lost, "torque_scale_Nm": torque}


def straight(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    lost, torque = min(pick(rng, 0.3, 0.5) * strength, 0.9), pick(rng, 4.0, 12.0)
    builder.add("p_load", builder.pure_error())
    builder.add("ke_gain", -lost * np.minimum(LOAD / torque, 1.0))
    return {"A_inf": 1 - lost, "flat_from_Nm": torque}


FORMS = (
    Form("load_dependent_kinematic_error", "exponential", exponential, textbook=True, strongest=1.9),
    Form("load_dependent_kinematic_error", "rational", rational, strongest=1.9),
    Form("load_dependent_kinematic_error", "unequal_orders", unequal_orders, strongest=1.9),
    Form("load_dependent_kinematic_error", "straight", straight, strongest=1.9),
)
