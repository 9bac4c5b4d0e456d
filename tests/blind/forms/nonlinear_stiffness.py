"""Spring that is not straight [physics B1]: cubic (textbook), three lines K1 < K2 < K3, soft wind-up by tanh."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import DEFLECTION, Builder
from tests.blind.forms.form import Form, Parameters, pick


def cubic(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    gain = builder.rig.K / 0.015**2 * pick(rng, 0.1, 0.25) * strength
    bent = np.clip(DEFLECTION, -0.03, 0.03)
    builder.add("spring", gain * bent**3)
    return {"k3_Nm_per_rad3": gain}


def three_lines(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    first, second = pick(rng, 0.0012, 0.002), pick(rng, 0.005, 0.008)
    one, two = pick(rng, 0.08, 0.2) * strength, pick(rng, 0.05, 0.15) * strength
    size = np.abs(DEFLECTION)
    extra = one * np.maximum(size - first, 0) + two * np.maximum(size - second, 0) - 0.6 * one * size
    builder.add("spring", builder.rig.K * np.sign(DEFLECTION) * extra)
    K = builder.rig.K
    return {"K1": K * (1 - 0.6 * one), "K2": K * (1 + 0.4 * one), "K3": K * (1 + 0.4 * one + two)}


def soft_start(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Missing torque that saturates: soft in the first minutes of arc, straight beyond."""
    width, missing = pick(rng, 0.0005, 0.0015), pick(rng, 0.15, 0.35) * min(strength, 2.4)
    builder.add("spring", -builder.rig.K * missing * width * np.tanh(DEFLECTION / width))
    return {"missing_share_at_zero": missing, "width_rad": width}


FORMS = (
    Form("nonlinear_stiffness", "cubic", cubic, textbook=True),
    Form("nonlinear_stiffness", "three_lines", three_lines),
    Form("nonlinear_stiffness", "soft_start", soft_start, strongest=2.4),
)
