"""Outside the library: a local bump of the kinematic error at one output angle."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, pick


def bump(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Between -15° and 15° of the output, so that the slow runs pass over it."""
    at, width = pick(rng, -0.18, 0.18), pick(rng, 0.012, 0.03)
    size = pick(rng, 4e-5, 1e-4) * strength
    away = np.angle(np.exp(1j * (ANGLE - at)))
    builder.add("p_out", size * np.exp(-((away / width) ** 2)))
    return {"at_rad": at, "width_rad": width, "height_rad": size}


FORMS = (Form("damaged_tooth", "bump", bump, coordinates=("load_angle",)),)
