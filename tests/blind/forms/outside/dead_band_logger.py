"""Outside the library: the logger repeats a torque until it has changed by a dead band."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def repeated(x: np.ndarray, band: float) -> np.ndarray:
    """`x` as a logger holds it that writes a new value when it is `band` away from the last."""
    out, last = np.empty_like(x), x[0]
    for i, value in enumerate(x):
        if abs(value - last) > band:
            last = value
        out[i] = last
    return out


def dead_band(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    band = pick(rng, 0.1, 0.25) * strength

    def read(columns: Columns, where: Context) -> None:
        columns["tau_l"] = repeated(columns["tau_l"], band)

    builder.sensors.changes.append(read)
    return {"band_Nm": band}


FORMS = (Form("dead_band_logger", "repeated", dead_band, strongest=10.0, coordinates=("memory", "load", "direction")),)
