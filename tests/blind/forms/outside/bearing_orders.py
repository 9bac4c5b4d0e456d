"""Outside the library: a worn wave-generator bearing, whose balls pass at no whole order [physics C6]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def worn(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Balls slip while nobody looks: each run begins at a phase of its own."""
    order, size = pick(rng, 11.2, 12.9), pick(rng, 4e-6, 1e-5) * strength
    if abs(order - round(order)) < 0.12:
        order += 0.25
    builder.set(odd_order=order, odd_size=size)
    return {"order": order, "amplitude_rad": size}


FORMS = (Form("bearing_orders", "worn", worn, strongest=6.0, coordinates=("motor_angle",)),)
