"""Stiffness modulated by angle [physics B5]: order two of the motor (textbook), several orders, two flat lobes."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def order_two(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, psi = pick(rng, 0.015, 0.04) * strength, phase(rng)
    builder.add("stiff_m", share * np.cos(2 * ANGLE - psi))
    return {"share_2": share, "phase_rad": psi}


def orders(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    out = {}
    for order, size in ((1, 0.006), (2, 0.02), (4, 0.01)):
        share, psi = size * pick(rng, 0.7, 1.3) * strength, phase(rng)
        builder.add("stiff_m", share * np.cos(order * ANGLE - psi))
        out[f"share_{order}"] = share
    return out


def square_teeth(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Two stiff lobes with flat tops: tanh of a cosine."""
    share, psi = pick(rng, 0.012, 0.03) * strength, phase(rng)
    builder.add("stiff_m", share * np.tanh(2.5 * np.cos(2 * ANGLE - psi)))
    return {"share": share}


FORMS = (
    Form("angle_dependent_stiffness", "order_two", order_two, textbook=True),
    Form("angle_dependent_stiffness", "orders", orders),
    Form("angle_dependent_stiffness", "square_teeth", square_teeth),
)
