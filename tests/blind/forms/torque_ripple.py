"""Motor torque ripple in proportion to the current [physics E2]: one order (textbook), pole-pair family, trapezoid."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def one_order(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    order, share = int(rng.choice([4, 8, 12, 24])), pick(rng, 0.015, 0.04) * strength
    builder.add("ripple", share * np.cos(order * ANGLE - phase(rng)))
    return {"order": order, "share": share}


def pole_pairs(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    pairs, share = int(rng.choice([3, 4, 5])), pick(rng, 0.015, 0.03) * strength
    for multiple, part in ((1, 0.5), (2, 0.8), (6, 1.0)):
        builder.add("ripple", part * share * np.cos(multiple * pairs * ANGLE - phase(rng)))
    return {"pole_pairs": pairs, "share_6p": share}


def trapezoid(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    pairs, share, psi = int(rng.choice([3, 4])), pick(rng, 0.015, 0.04) * strength, phase(rng)
    x = 6 * pairs * ANGLE - psi
    builder.add("ripple", share * np.tanh(2 * np.cos(x)))
    return {"pole_pairs": pairs, "share": share}


FORMS = (
    Form("torque_ripple", "one_order", one_order, textbook=True),
    Form("torque_ripple", "pole_pairs", pole_pairs),
    Form("torque_ripple", "trapezoid", trapezoid),
)
