"""Dead zone at zero torque [physics B3]: sharp (textbook), rounded, and one whose two sides differ,
one that is soft."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import DEFLECTION, Builder
from tests.blind.forms.form import Form, Parameters, pick


def beyond(width: float) -> np.ndarray:
    """Deflection minus what a gap of half-width `width` takes up."""
    return np.sign(DEFLECTION) * np.maximum(np.abs(DEFLECTION) - width, 0)


def sharp(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    gap = pick(rng, 2e-5, 5e-5) * strength
    builder.add("spring", builder.rig.K * (beyond(gap) - DEFLECTION))
    return {"half_gap_rad": gap}


def rounded(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    gap = pick(rng, 2e-5, 5e-5) * strength
    soft = 0.35 * gap
    over = soft * np.logaddexp(0, (np.abs(DEFLECTION) - gap) / soft) - soft * np.log1p(np.exp(-gap / soft))
    builder.add("spring", builder.rig.K * (np.sign(DEFLECTION) * over - DEFLECTION))
    return {"half_gap_rad": gap, "rounding_rad": soft}


def uneven(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A gap of which 5 % of the stiffness stays, wider on one side."""
    left, right = (pick(rng, 1.5e-5, 5e-5) * strength for _ in range(2))
    inside = np.clip(DEFLECTION, -left, right)
    builder.add("spring", -0.95 * builder.rig.K * inside)
    return {"gap_left_rad": left, "gap_right_rad": right}


def soft_gap(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A third of the stiffness within the gap, and a smooth way out of it."""
    gap, stays = pick(rng, 3e-5, 7e-5) * strength, pick(rng, 0.25, 0.4)
    builder.add("spring", -(1 - stays) * builder.rig.K * gap * np.tanh(DEFLECTION / gap))
    return {"half_gap_rad": gap, "stiffness_share": stays}


FORMS = (
    Form("lost_motion", "sharp", sharp, textbook=True, strongest=6.0),
    Form("lost_motion", "rounded", rounded, strongest=6.0),
    Form("lost_motion", "uneven", uneven, strongest=6.0),
    Form("lost_motion", "soft_gap", soft_gap, strongest=6.0),
)
