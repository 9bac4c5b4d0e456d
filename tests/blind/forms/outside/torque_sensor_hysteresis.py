"""Outside the library: the torque sensor keeps a part of its last excursion (play operators on the torque)."""

from __future__ import annotations

import numpy as np
from numba import njit

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


@njit(cache=True)
def play(x: np.ndarray, width: float) -> np.ndarray:
    out = np.empty_like(x)
    y = x[0]
    for i in range(len(x)):
        y = min(max(y, x[i] - width), x[i] + width)
        out[i] = y
    return out


def sensor(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    gain = pick(rng, 0.004, 0.01) * strength
    widths = np.array([1.0, 6.0, 25.0]) * pick(rng, 0.7, 1.3)

    def read(columns: Columns, where: Context) -> None:
        true = columns["tau_l"].copy()
        for width in widths:
            columns["tau_l"] += gain * (play(true, float(width)) - true)

    builder.sensors.changes.append(read)
    return {"gain_per_play": gain}


FORMS = (Form("torque_sensor_hysteresis", "plays", sensor, coordinates=("memory", "load", "direction")),)
