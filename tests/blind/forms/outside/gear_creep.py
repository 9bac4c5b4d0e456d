"""Outside the library: the gear relaxes under torque, with three times between seconds and minutes [physics B9]."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def creep(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    share = pick(rng, 0.004, 0.012) * strength
    builder.add("creep_k", np.full(3, share * builder.rig.K))
    builder.add("creep_tau", np.array([1.5, 9.0, 60.0]) * pick(rng, 0.7, 1.4))
    return {"share_per_branch": share}


FORMS = (Form("gear_creep", "three_times", creep, coordinates=("memory", "load", "time")),)
