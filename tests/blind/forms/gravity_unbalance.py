"""Torque once per output turn on the load [physics E4]: sine (textbook), with a second order, eccentric mass."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def sine(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    torque, psi = pick(rng, 0.3, 1.0) * strength, phase(rng)
    builder.add("on_load", -torque * np.sin(ANGLE - psi))
    return {"torque_Nm": torque, "phase_rad": psi}


def two_orders(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    second, psi = pick(rng, 0.1, 0.3), phase(rng)
    out = sine(builder, rng, strength)
    builder.add("on_load", -second * out["torque_Nm"] * np.sin(2 * ANGLE - psi))
    return out | {"share_2": second}


def eccentric_mass(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A mass on a tilted swinging arm: the lever arm shortens on one side."""
    torque, psi, skew = pick(rng, 0.3, 1.0) * strength, phase(rng), pick(rng, 0.1, 0.25)
    builder.add("on_load", -torque * np.sin(ANGLE - psi) / (1 + skew * np.cos(ANGLE - psi)))
    return {"torque_Nm": torque, "phase_rad": psi, "skew": skew}


FORMS = (
    Form("gravity_unbalance", "sine", sine, textbook=True),
    Form("gravity_unbalance", "two_orders", two_orders),
    Form("gravity_unbalance", "eccentric_mass", eccentric_mass),
)
