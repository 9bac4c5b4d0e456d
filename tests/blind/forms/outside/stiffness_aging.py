"""Outside the library: the gear softens while the campaign is taken."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def aging(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share = min(pick(rng, 0.02, 0.06) * strength, 0.4)
    builder.set(aging=-share)
    return {"lost_share_per_half_hour": share}


FORMS = (Form("stiffness_aging", "linear_in_time", aging, coordinates=("time", "load")),)
