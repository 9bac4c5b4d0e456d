"""Friction that falls as the drive warms [physics A5]: one constant (textbook), two, heated by its losses,
by a root of time."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def one_constant(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    tau, viscous = pick(rng, 500.0, 1100.0), min(pick(rng, 0.25, 0.45) * strength, 2.0)
    dry = 0.4 * viscous
    builder.set(warm_v=viscous, warm_c=dry, warm_tau_1=tau)
    return {"viscous_share": viscous, "dry_share": dry, "tau_s": tau}


def two_constants(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    tau_1, tau_2, share = pick(rng, 150.0, 350.0), pick(rng, 1000.0, 2200.0), pick(rng, 0.35, 0.65)
    viscous = min(pick(rng, 0.3, 0.5) * strength, 2.0)
    dry = pick(rng, 0.2, 0.8) * viscous
    builder.set(warm_v=viscous, warm_c=dry, warm_tau_1=tau_1, warm_tau_2=tau_2, warm_share=share)
    return {"viscous_share": viscous, "dry_share": dry, "tau_1_s": tau_1, "tau_2_s": tau_2}


def self_heating(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Dry and viscous friction fall with the heat that friction itself has put in, which leaks with `tau`."""
    tau, gain = pick(rng, 900.0, 1800.0), pick(rng, 2e-4, 4e-4) * strength
    builder.set(heat_gain=gain, heat_tau=tau)
    return {"fall_per_joule": gain, "leak_s": tau}


def root_of_time(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Falls like one over a root: fast at first, and never done."""
    tau, viscous = pick(rng, 60.0, 200.0), min(pick(rng, 0.3, 0.6) * strength, 2.0)
    dry = pick(rng, 0.2, 0.8) * viscous
    builder.set(warm_v=viscous, warm_c=dry, warm_tau_1=tau, warm_root=1)
    return {"viscous_share": viscous, "dry_share": dry, "tau_s": tau}


FORMS = (
    Form("thermal_friction_drift", "one_constant", one_constant, textbook=True),
    Form("thermal_friction_drift", "two_constants", two_constants),
    Form("thermal_friction_drift", "self_heating", self_heating),
    Form("thermal_friction_drift", "root_of_time", root_of_time),
)
