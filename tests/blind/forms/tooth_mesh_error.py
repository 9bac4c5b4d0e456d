"""Orders of the tooth count [physics C5]: 102 (textbook), 102 with 204, 100 and 102 together."""

from __future__ import annotations

from functools import partial

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick

SHARES = {"order_102": {102: 1.0}, "with_204": {102: 1.0, 204: 0.4}, "both_gears": {100: 0.6, 102: 1.0}}


def mesh(name: str, builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    size, out = pick(rng, 3e-6, 1e-5) * strength, {}
    for order, share in SHARES[name].items():
        builder.add("p", share * size * np.cos(order * ANGLE - phase(rng)))
        out[f"amplitude_{order}_rad"] = share * size
    return out


FORMS = tuple(
    Form("tooth_mesh_error", name, partial(mesh, name), textbook=name == "order_102", strongest=4.0) for name in SHARES
)
