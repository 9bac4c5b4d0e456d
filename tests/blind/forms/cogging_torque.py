"""Motor torque ripple at rest [physics E1]: one order (textbook), its harmonics too, a saw-like detent."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def one_order(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    order, size = int(rng.choice([12, 18, 24, 36])), pick(rng, 0.006, 0.015) * strength
    builder.add("cogging", size * np.cos(order * ANGLE - phase(rng)))
    return {"order": order, "torque_Nm": size}


def harmonics(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    order, size = int(rng.choice([6, 12, 18])), pick(rng, 0.006, 0.015) * strength
    for multiple, share in ((1, 1.0), (2, 0.45), (3, 0.2)):
        builder.add("cogging", share * size * np.cos(multiple * order * ANGLE - phase(rng)))
    return {"order": order, "torque_Nm": size}


def detent(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    order, size, psi = int(rng.choice([8, 12, 20])), pick(rng, 0.006, 0.015) * strength, phase(rng)
    x = order * ANGLE - psi
    builder.add("cogging", size * np.sin(x + 0.5 * np.sin(x)))
    return {"order": order, "torque_Nm": size}


FORMS = (
    Form("cogging_torque", "one_order", one_order, textbook=True),
    Form("cogging_torque", "harmonics", harmonics),
    Form("cogging_torque", "detent", detent),
)
