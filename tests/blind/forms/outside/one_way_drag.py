"""Outside the library: a seal drags in one direction only, with the root of the speed."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import SPEED, Builder
from tests.blind.forms.form import Form, Parameters, pick


def seal(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    drag = pick(rng, 0.01, 0.03) * strength
    builder.add("friction_forward", drag * np.sqrt(SPEED / 20.0))
    builder.add("friction_backward", np.zeros_like(SPEED))
    return {"drag_at_20rad_s_Nm": drag}


FORMS = (Form("one_way_drag", "seal", seal, coordinates=("direction", "speed")),)
