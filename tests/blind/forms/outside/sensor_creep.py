"""Outside the library: the gauges of the torque sensor creep under load."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def creeping(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, tau = pick(rng, 0.004, 0.012) * strength, pick(rng, 10.0, 40.0)

    def read(columns: Columns, where: Context) -> None:
        t, x, strain = columns["t"], columns["tau_l"], 0.0
        crept = np.empty_like(x)
        for i, dt in enumerate(np.diff(t, prepend=t[0])):
            strain += dt / tau * (x[i] - strain)
            crept[i] = strain
        columns["tau_l"] = x + share * crept

    builder.sensors.changes.append(read)
    return {"share": share, "tau_s": tau}


FORMS = (Form("sensor_creep", "creeping", creeping, strongest=10.0, coordinates=("memory", "time", "load")),)
