"""Outside the library: the torque sensor is not straight, and not the same both ways."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def bent(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    even, odd = pick(rng, 0.005, 0.015) * strength, pick(rng, -0.01, 0.01) * strength

    def read(columns: Columns, where: Context) -> None:
        x = columns["tau_l"] / 40.0
        columns["tau_l"] += 40.0 * (even * x**2 + odd * x**3)

    builder.sensors.changes.append(read)
    return {"even_share_at_40Nm": even, "odd_share_at_40Nm": odd}


FORMS = (Form("sensor_curve", "bent", bent, strongest=10.0, coordinates=("load",)),)
