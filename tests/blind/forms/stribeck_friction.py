"""Friction that falls with speed near rest [physics A1]: Gaussian (textbook), exponential, Lorentzian, straight."""

from __future__ import annotations

from functools import partial

import numpy as np

from tests.blind.builder import SPEED, Builder
from tests.blind.forms.form import Form, Parameters, pick

DECAY = {
    "gaussian": lambda x: np.exp(-(x**2)),
    "exponential": lambda x: np.exp(-x),
    "lorentzian": lambda x: 1 / (1 + x**2),
    "ramp": lambda x: np.maximum(1 - 0.6 * x, 0),
}


def stribeck(shape: str, builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    speed = pick(rng, 0.9, 5.0)
    rise = builder.rig.T_c * pick(rng, 0.25, 0.4) * strength
    for side in ("friction_forward", "friction_backward"):
        builder.add(side, rise * DECAY[shape](SPEED / speed))
    return {"rise_Nm": rise, "stribeck_speed_rad_s": speed}


FORMS = tuple(
    Form("stribeck_friction", name, partial(stribeck, name), textbook=name == "gaussian", strongest=1.6)
    for name in DECAY
)
