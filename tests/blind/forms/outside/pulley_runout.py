"""Outside the library: the pulley from which the weight hangs is eccentric [physics E4]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def eccentric(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share, psi = pick(rng, 0.005, 0.02) * strength, phase(rng)
    builder.add("pulley", share * np.cos(ANGLE - psi))
    return {"share": share}


FORMS = (Form("pulley_runout", "eccentric", eccentric, strongest=10.0, coordinates=("load_angle", "load")),)
