"""Friction modulated by the wave generator [physics A4]: order two (textbook), several orders, tight spots."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def order_two(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, psi = pick(rng, 0.06, 0.14) * strength, phase(rng)
    builder.add("friction_angle", share * np.cos(2 * ANGLE - psi))
    return {"share_2": share, "phase_rad": psi}


def orders(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    out = {}
    for order, size in ((1, 0.03), (2, 0.09), (4, 0.04)):
        share, psi = size * pick(rng, 0.7, 1.3) * strength, phase(rng)
        builder.add("friction_angle", share * np.cos(order * ANGLE - psi))
        out[f"share_{order}"] = share
    return out


def tight_spots(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, psi, sharp = pick(rng, 0.15, 0.3) * strength, phase(rng), pick(rng, 2.0, 5.0)
    bump = np.exp(sharp * (np.cos(2 * ANGLE - psi) - 1))
    builder.add("friction_angle", share * (bump - bump.mean()))
    return {"share_peak": share, "sharpness": sharp}


def with_flexspline(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Half of it goes round with the flexspline: order 2.04 beside order 2."""
    share, psi, phi = pick(rng, 0.06, 0.14) * strength, phase(rng), phase(rng)
    builder.add("friction_angle", share * np.cos(2 * ANGLE - psi))
    builder.add("friction_frame", 0.5 * share * np.cos(2 * ANGLE - phi))
    return {"share_2": share, "share_2p04": 0.5 * share}


FORMS = (
    Form("position_dependent_friction", "order_two", order_two, textbook=True),
    Form("position_dependent_friction", "orders", orders),
    Form("position_dependent_friction", "tight_spots", tight_spots),
    Form("position_dependent_friction", "with_flexspline", with_flexspline),
)
