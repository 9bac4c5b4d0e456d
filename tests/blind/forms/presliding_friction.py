"""Friction with memory around reversals [physics A3]: LuGre (textbook), two elasto-slip elements, Dahl."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.kernel import ELEMENTS, LUGRE


def lugre(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """`strength` stretches the presliding distance: a softer bristle is a larger effect."""
    distance = pick(rng, 0.003, 0.006) * strength
    sigma = builder.rig.T_c / distance
    damping = 0.2 * float(np.sqrt(sigma * builder.rig.J_m))
    builder.set(friction=LUGRE, sigma_0=sigma, sigma_1=damping)
    return {"sigma_0_Nm_per_rad": sigma, "sigma_1_Nms_per_rad": damping, "distance_rad": distance}


def dahl(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    distance = pick(rng, 0.003, 0.008) * strength
    builder.set(friction=LUGRE, sigma_0=builder.rig.T_c / distance, sigma_1=0.0)
    return {"sigma_0_Nm_per_rad": builder.rig.T_c / distance, "distance_rad": distance}


def two_elements(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    distance, share = pick(rng, 0.003, 0.008) * strength, pick(rng, 0.4, 0.6)
    sigma = builder.rig.T_c / distance
    builder.set(friction=ELEMENTS, sigma_0=sigma, sigma_1=0.05, share=share)
    return {"sigma_0_Nm_per_rad": sigma, "share_of_the_stiffer": share, "distance_rad": distance}


FORMS = (
    Form("presliding_friction", "lugre", lugre, textbook=True, weakest=0.5, strongest=6.0),
    Form("presliding_friction", "two_elements", two_elements, weakest=0.5, strongest=6.0),
    Form("presliding_friction", "dahl", dahl, weakest=0.5, strongest=6.0),
)
