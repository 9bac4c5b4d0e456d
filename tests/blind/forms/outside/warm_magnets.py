"""Outside the library: the motor gives less torque for its current as its magnets warm [physics E3]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def fading(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, tau = pick(rng, 0.01, 0.03) * strength, pick(rng, 400.0, 1200.0)

    def read(columns: Columns, where: Context) -> None:
        warm = -np.expm1(-(columns["t"] + where.start_s) / tau)
        columns["tau_m"] *= 1 + share * warm

    builder.sensors.changes.append(read)
    return {"share": share, "tau_s": tau}


FORMS = (Form("warm_magnets", "fading", fading, strongest=10.0, coordinates=("time", "load", "temperature")),)
