"""Outside the library: the gear is stiffer one way than the other."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import DEFLECTION, Builder
from tests.blind.forms.form import Form, Parameters, pick


def one_sided(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    more, past = pick(rng, 0.04, 0.12) * strength, pick(rng, 0.0003, 0.001)
    over = past * np.logaddexp(0, DEFLECTION / past) - past * np.log(2)
    builder.add("spring", more * builder.rig.K * (over - 0.5 * DEFLECTION))
    return {"share": more, "bend_rad": past}


FORMS = (Form("one_sided_spring", "bent", one_sided, coordinates=("load", "direction")),)
