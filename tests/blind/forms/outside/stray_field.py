"""Outside the library: the field of the motor current reaches the encoder of the motor."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def shifted(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Against the way a soft coupling would give, which it could not be told from."""
    shift = -pick(rng, 0.001, 0.004) * strength

    def read(columns: Columns, where: Context) -> None:
        columns["theta_m"] += shift * columns["tau_m"]

    builder.sensors.changes.append(read)
    return {"rad_per_Nm": shift}


FORMS = (Form("stray_field", "shifted", shifted, strongest=10.0, coordinates=("load", "direction")),)
