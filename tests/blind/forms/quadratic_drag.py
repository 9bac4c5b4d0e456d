"""Drag that grows faster than speed: with its square (textbook), its power 1.7, or from an onset of churning on."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import SPEED, Builder
from tests.blind.forms.form import Form, Parameters, pick

TOP = 40.0  # rad/s, near the fastest run: sizes are quoted there


def both(builder: Builder, table: np.ndarray) -> None:
    builder.add("friction_forward", table)
    builder.add("friction_backward", table)


def square(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    drag = pick(rng, 0.02, 0.05) * strength
    both(builder, drag * (SPEED / TOP) ** 2)
    return {"drag_Nms2_per_rad2": drag / TOP**2}


def power_1p7(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    drag = pick(rng, 0.02, 0.05) * strength
    both(builder, drag * (SPEED / TOP) ** 1.7)
    return {"drag_at_40rad_s_Nm": drag}


def onset(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    drag, start = pick(rng, 0.02, 0.05) * strength, pick(rng, 4.0, 9.0)
    both(builder, drag * (np.maximum(SPEED - start, 0) / (TOP - start)) ** 2)
    return {"drag_at_40rad_s_Nm": drag, "onset_rad_s": start}


FORMS = (
    Form("quadratic_drag", "square", square, textbook=True),
    Form("quadratic_drag", "power_1p7", power_1p7),
    Form("quadratic_drag", "onset", onset),
)
