"""Outside the library: a dent in the bearing of the output, a torque at one angle, by the weight that presses."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, pick


def dent(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    at, width, share = pick(rng, -0.15, 0.15), pick(rng, 0.01, 0.03), pick(rng, 0.01, 0.04) * strength
    away = np.angle(np.exp(1j * (ANGLE - at)))
    builder.add("pulley", share * away / width * np.exp(0.5 - 0.5 * (away / width) ** 2))
    return {"at_rad": at, "width_rad": width, "share": share}


FORMS = (Form("dented_bearing", "dent", dent, strongest=10.0, coordinates=("load_angle", "load")),)
