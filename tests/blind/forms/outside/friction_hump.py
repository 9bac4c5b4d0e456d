"""Outside the library: the wave-generator bearing skids in one band of speed and drags there."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import SPEED, Builder
from tests.blind.forms.form import Form, Parameters, pick


def hump(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    at, width, drag = pick(rng, 18.0, 26.0), pick(rng, 2.5, 5.0), pick(rng, 0.015, 0.04) * strength
    table = drag * np.exp(-(((SPEED - at) / width) ** 2))
    builder.add("friction_forward", table)
    builder.add("friction_backward", table)
    return {"at_rad_s": at, "width_rad_s": width, "drag_Nm": drag}


FORMS = (Form("friction_hump", "band", hump, coordinates=("speed",)),)
