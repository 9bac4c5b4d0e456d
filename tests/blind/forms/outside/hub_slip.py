"""Outside the library: the load encoder's hub slips a little, the faster the larger the torque [physics F6]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def slip(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    rate = pick(rng, 5e-8, 2e-7) * strength

    def read(columns: Columns, where: Context) -> None:
        torque = columns["tau_l"]
        over = np.sign(torque) * np.maximum(np.abs(torque) - 1.0, 0.0)
        columns["theta_l"] += rate * np.cumsum(over * np.gradient(columns["t"]))

    builder.sensors.changes.append(read)
    return {"rate_rad_per_Nms": rate}


FORMS = (Form("hub_slip", "beyond_1_Nm", slip, coordinates=("memory", "time", "load")),)
