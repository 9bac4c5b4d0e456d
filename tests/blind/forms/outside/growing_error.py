"""Outside the library: the kinematic error grows while the campaign is taken: a bearing comes loose."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def growing(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share = pick(rng, 0.05, 0.15) * strength
    builder.set(ke_aging=share)
    return {"growth_per_half_hour": share}


FORMS = (Form("growing_error", "linear_in_time", growing, coordinates=("time", "motor_angle")),)
