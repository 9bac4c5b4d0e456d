"""Rate-independent loop of torque against wind-up [physics B2]: elasto-slip (textbook), Bouc-Wen, Dahl; and two whose
branches are not alike, slip that gives way sooner one way and an asymmetric Bouc-Wen law."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.kernel import BOUC_WEN, MAXWELL


def maxwell(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Eight elements, slip limits spread over a decade and a half: minor loops close (Iwan)."""
    limits = np.geomspace(1.5e-4, 6e-3, 8) * rng.uniform(0.8, 1.25, 8)
    weight = rng.uniform(0.5, 1.5, 8) / limits**0.6
    torque = pick(rng, 0.6, 1.6) * strength
    stiff = weight * torque / np.sum(weight * limits)
    builder.set(hysteresis=MAXWELL)
    builder.add("slip_k", stiff)
    builder.add("slip_x", limits)
    return {"loop_half_width_Nm": torque}


def bouc_wen(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    reach, torque = pick(rng, 6e-4, 2e-3), pick(rng, 0.5, 1.4) * strength
    beta, n = pick(rng, 0.5, 0.7), pick(rng, 1.0, 1.8)
    builder.set(hysteresis=BOUC_WEN, bw_x=reach, bw_k=torque / reach, bw_beta=beta, bw_n=n)
    return {"loop_half_width_Nm": torque, "reach_rad": reach, "beta": beta, "n": n}


def dahl(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    reach, torque = pick(rng, 4e-4, 2e-3), pick(rng, 0.5, 1.4) * strength
    builder.set(hysteresis=BOUC_WEN, bw_x=reach, bw_k=torque / reach, bw_beta=1.0, bw_n=1.0)
    return {"loop_half_width_Nm": torque, "reach_rad": reach}


def uneven_slip(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Eight elements that hold less one way than the other."""
    back = pick(rng, 0.35, 0.7)
    builder.set(slip_back=back)
    return {**maxwell(builder, rng, strength), "holds_less_back_by": back}


def lopsided(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    delta = pick(rng, 0.15, 0.4) * float(rng.choice([-1, 1]))
    builder.set(bw_delta=delta)
    return {**bouc_wen(builder, rng, strength), "delta": delta}


FORMS = (
    Form("hysteretic_stiffness", "maxwell", maxwell, textbook=True),
    Form("hysteretic_stiffness", "bouc_wen", bouc_wen),
    Form("hysteretic_stiffness", "dahl", dahl),
    Form("hysteretic_stiffness", "uneven_slip", uneven_slip),
    Form("hysteretic_stiffness", "lopsided", lopsided),
)
