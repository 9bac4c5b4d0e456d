"""Outside the library: friction goes up and down with the air of the room."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def breathing(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, period, psi = pick(rng, 0.03, 0.08) * strength, pick(rng, 150.0, 400.0), phase(rng)
    viscous = builder.rig.B_m + builder.rig.B_ml

    def read(columns: Columns, where: Context) -> None:
        t = columns["t"]
        speed = np.gradient(columns["theta_m"], t)
        rubs = builder.rig.T_c * np.tanh(speed / 0.05) + viscous * speed
        columns["tau_m"] += share * rubs * np.sin(2 * np.pi * (t + where.start_s) / period + psi)

    builder.sensors.changes.append(read)
    return {"share": share, "period_s": period}


FORMS = (Form("draughty_room", "breathing", breathing, strongest=6.0, coordinates=("time", "time_periodic")),)
