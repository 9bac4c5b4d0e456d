"""Once per motor turn in the motor encoder alone [physics D3]: sine (textbook), exact disc, with ellipticity."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick


def sine(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    size, psi = pick(rng, 2e-3, 4e-3) * strength, phase(rng)
    builder.add("encoder_m", size * np.sin(ANGLE - psi))
    return {"amplitude_rad": size, "phase_rad": psi}


def disc(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    ratio, psi = pick(rng, 2e-3, 4e-3) * strength, phase(rng)
    builder.add("encoder_m", np.arctan2(ratio * np.sin(ANGLE - psi), 1 - ratio * np.cos(ANGLE - psi)))
    return {"amplitude_rad": ratio, "phase_rad": psi}


def with_ellipticity(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    out = sine(builder, rng, strength)
    builder.add("encoder_m", 0.25 * out["amplitude_rad"] * np.sin(2 * ANGLE - phase(rng)))
    return out | {"amplitude_2_rad": 0.25 * out["amplitude_rad"]}


FORMS = (
    Form("motor_encoder_eccentricity", "sine", sine, textbook=True, strongest=8.0),
    Form("motor_encoder_eccentricity", "disc", disc, strongest=8.0),
    Form("motor_encoder_eccentricity", "with_ellipticity", with_ellipticity, strongest=8.0),
)
