"""Outside the library: the torque sensor's gain follows the temperature of its housing, which a channel records."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def gain(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The hall's heating switches with a period of some minutes: temperature is no function of run order."""
    per_kelvin, period, psi = pick(rng, 0.001, 0.003) * strength, pick(rng, 240.0, 500.0), phase(rng)

    def read(columns: Columns, where: Context) -> None:
        kelvin = 4.0 * np.sin(2 * np.pi * (columns["t"] + where.start_s) / period + psi)
        columns["temperature"] = np.round(24.0 + kelvin + 0.02 * where.rng.standard_normal(len(kelvin)), 2)
        columns["tau_l"] *= 1 + per_kelvin * kelvin

    builder.sensors.changes.append(read)
    return {"gain_per_kelvin": per_kelvin}


FORMS = (Form("sensor_gain_temperature", "recorded", gain, coordinates=("temperature", "time", "load")),)
