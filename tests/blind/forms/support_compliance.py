"""The housing moves on its support [physics B6]: sprung and damped (textbook), heavy and slow, with rubbing feet."""

from __future__ import annotations

from functools import partial

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.kernel import HOUSING

BAND = {"sprung": (35.0, 80.0, 0.0), "slow": (22.0, 35.0, 0.0), "rubbing": (35.0, 80.0, 0.15)}


def housing(name: str, builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """`strength` is the compliance of the support relative to a typical one; N·m/rad 1e5 is typical for 1."""
    low, high, rub = BAND[name]
    hz, damping = pick(rng, low, high), pick(rng, 0.01, 0.05)
    k = pick(rng, 7e4, 1.6e5) / strength
    J_x = k / (2 * np.pi * hz) ** 2
    builder.set(extra=HOUSING, J_x=J_x, k_x=k, c_x=2 * damping * np.sqrt(k * J_x), dry_x=rub)
    return {"stiffness_Nm_per_rad": k, "frequency_hz": hz, "damping_ratio": damping, "rubbing_Nm": rub}


FORMS = tuple(Form("support_compliance", name, partial(housing, name), textbook=name == "sprung") for name in BAND)
