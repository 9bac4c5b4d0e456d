"""Outside the library: the motor's torque lags its current by magnetic memory (play operators)."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def magnetic(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    gain = pick(rng, 0.05, 0.12) * strength
    builder.add("play_k", np.array([gain, 0.6 * gain]))
    builder.add("play_x", np.array([0.08, 0.4]) * pick(rng, 0.7, 1.3))
    return {"gain": gain}


FORMS = (Form("magnetic_hysteresis", "plays", magnetic, coordinates=("memory", "direction", "load")),)
