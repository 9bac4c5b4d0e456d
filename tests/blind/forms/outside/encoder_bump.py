"""Outside the library: a scratch in the track of the motor encoder: a bump of few degrees."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def scratch(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    at, width, size = phase(rng), pick(rng, 0.03, 0.1), pick(rng, 5e-4, 2e-3) * strength
    away = np.angle(np.exp(1j * (ANGLE - at)))
    builder.add("encoder_m", size * np.exp(-((away / width) ** 2)))
    return {"at_rad": at, "width_rad": width, "height_rad": size}


FORMS = (Form("encoder_bump", "scratch", scratch, strongest=10.0, coordinates=("motor_angle",)),)
