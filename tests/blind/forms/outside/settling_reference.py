"""Outside the library: the reference of the current measurement settles within seconds of each start."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def settling(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, tau = pick(rng, 0.03, 0.08) * strength, pick(rng, 2.0, 7.0)

    def read(columns: Columns, where: Context) -> None:
        columns["tau_m"] *= 1 + share * np.exp(-columns["t"] / tau)

    builder.sensors.changes.append(read)
    return {"share": share, "tau_s": tau}


FORMS = (Form("settling_reference", "settling", settling, strongest=10.0, coordinates=("time", "memory")),)
