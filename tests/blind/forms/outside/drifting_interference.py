"""Outside the library: an interference on the torque sensor whose frequency wanders, so that no line stands still."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def wandering(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    hz, size, psi = pick(rng, 4.0, 15.0), pick(rng, 0.06, 0.2) * strength, phase(rng)
    swing, slow = pick(rng, 0.1, 0.25), pick(rng, 0.004, 0.02)

    def read(columns: Columns, where: Context) -> None:
        t = columns["t"] + where.start_s
        cycles = hz * t + hz * swing / (2 * np.pi * slow) * np.sin(2 * np.pi * slow * t)
        columns["tau_l"] += size * np.sin(2 * np.pi * cycles + psi)

    builder.sensors.changes.append(read)
    return {"frequency_hz": hz, "swing_share": swing, "torque_Nm": size}


FORMS = (Form("drifting_interference", "wandering", wandering, coordinates=("time_periodic", "time")),)
