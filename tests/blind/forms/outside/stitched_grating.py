"""Outside the library: a load encoder's scale is stitched from segments, each a little too short."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context


def sawtooth(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A slow run of ±1440° sees less than one of them, the speed runs go over several."""
    segments, size = int(rng.integers(7, 20)), pick(rng, 1e-5, 3e-5) * strength

    def read(columns: Columns, where: Context) -> None:
        along = segments * columns["theta_l"] / (2 * np.pi)
        columns["theta_l"] += size * (2 * (along - np.floor(along)) - 1)

    builder.sensors.changes.append(read)
    return {"segments": segments, "size_rad": size}


FORMS = (Form("stitched_grating", "sawtooth", sawtooth, coordinates=("load_angle",)),)
