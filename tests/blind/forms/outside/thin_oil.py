"""Outside the library: viscous friction grows less than the speed [physics A6]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import SPEED, Builder
from tests.blind.forms.form import Form, Parameters, pick


def sublinear(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A drag of a power below one, with as much of the straight one taken off: the curvature alone is left."""
    power, drag = pick(rng, 0.4, 0.7), pick(rng, 0.02, 0.05) * strength
    curve = drag * ((SPEED / 40.0) ** power - SPEED / 40.0)
    builder.add("friction_forward", curve)
    builder.add("friction_backward", curve)
    return {"power": power, "drag_at_40rad_s_Nm": drag}


FORMS = (Form("thin_oil", "sublinear", sublinear, strongest=4.0, coordinates=("speed",)),)
