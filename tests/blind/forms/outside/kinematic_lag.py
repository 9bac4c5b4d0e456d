"""Outside the library: the kinematic error is carried along by the direction of turning [physics C7, Jia 2021]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def carried(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    angle, reach = pick(rng, 0.02, 0.05) * strength, pick(rng, 0.02, 0.08)
    builder.set(lag_angle=angle, lag_scale=reach)
    return {"shift_rad": angle, "reach_rad": reach}


FORMS = (Form("kinematic_lag", "shift", carried, coordinates=("motor_angle", "direction", "memory")),)
