"""Mesh friction that grows with the torque [physics A2]: linear (textbook), by power flow, saturating with load,
past a threshold."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import LOAD, Builder
from tests.blind.forms.form import Form, Parameters, pick


def linear(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    mu = pick(rng, 0.05, 0.12) * strength
    builder.add("friction_load", mu * LOAD / builder.rig.N)
    return {"mu": mu}


def power_flow(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    back = pick(rng, 0.5, 0.85)
    builder.set(back_driven=back)
    return linear(builder, rng, strength) | {"back_driven_share": back}


def saturating(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    knee, mu = pick(rng, 25.0, 60.0), pick(rng, 0.08, 0.16) * strength
    builder.add("friction_load", mu * knee * LOAD / (LOAD + knee) / builder.rig.N)
    return {"mu_at_no_load": mu, "knee_Nm": knee}


def power_1p2(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    mu = pick(rng, 0.05, 0.1) * strength
    builder.add("friction_load", mu * 20.0 * np.power(LOAD / 20.0, 1.2) / builder.rig.N)
    return {"mu_at_20Nm": mu}


def threshold(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    mu, past = pick(rng, 0.06, 0.14) * strength, pick(rng, 3.0, 9.0)
    builder.add("friction_load", mu * np.maximum(LOAD - past, 0.0) / builder.rig.N)
    return {"mu": mu, "past_Nm": past}


FORMS = (
    Form("load_dependent_friction", "linear", linear, textbook=True),
    Form("load_dependent_friction", "power_flow", power_flow),
    Form("load_dependent_friction", "saturating", saturating),
    Form("load_dependent_friction", "power_1p2", power_1p2),
    Form("load_dependent_friction", "threshold", threshold),
)
