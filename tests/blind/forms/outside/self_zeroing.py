"""Outside the library: the transducer of the motor current drifts, and zeroes itself at even intervals."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def sawtooth(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    size, period, begun = pick(rng, 0.004, 0.012) * strength, pick(rng, 7.0, 20.0), phase(rng)

    def read(columns: Columns, where: Context) -> None:
        cycles = (columns["t"] + where.start_s) / period + begun
        columns["tau_m"] += size * (cycles % 1.0 - 0.5)

    builder.sensors.changes.append(read)
    return {"torque_Nm": size, "period_s": period}


FORMS = (Form("self_zeroing", "sawtooth", sawtooth, strongest=10.0, coordinates=("time_periodic", "time")),)
