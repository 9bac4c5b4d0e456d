"""Orders that ride on the flexspline [physics C3]: 2.04 (textbook), with 4.08, with 1.02."""

from __future__ import annotations

from functools import partial

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick

SHARES = {"order_2p04": {2: 1.0}, "with_4p08": {2: 1.0, 4: 0.45}, "with_1p02": {1: 0.5, 2: 1.0, 4: 0.2}}


def frame(name: str, builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A table over theta_m + theta_l: the wave generator seen from the flexspline turns 1 + 1/N times as far."""
    size, out = pick(rng, 1.5e-5, 5e-5) * strength, {}
    for order, share in SHARES[name].items():
        builder.add("p_frame", share * size * np.cos(order * ANGLE - phase(rng)))
        out[f"amplitude_{order * 1.02:.2f}_rad"] = share * size
    return out


FORMS = tuple(
    Form("flexspline_frame_error", name, partial(frame, name), textbook=name == "order_2p04") for name in SHARES
)
