"""Outside the library: the drive gives no torque below a current, and correspondingly less above."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def dead_zone(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    width = pick(rng, 0.01, 0.03) * strength
    builder.set(dead_zone=width)
    return {"half_width_Nm": width}


FORMS = (Form("motor_dead_zone", "symmetric", dead_zone, coordinates=("load", "direction")),)
