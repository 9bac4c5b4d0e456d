"""A second resonance beyond the gear's own [physics B7]: split load disc (textbook), motor coupling, sensor shaft."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.kernel import COUPLING, DISC, SENSOR_SHAFT


def coupled(one: float, two: float) -> float:
    return one * two / (one + two)


def disc(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Part of the load hangs on an elastic flange; `strength` is how large that part is."""
    hz, damping = pick(rng, 35.0, 75.0), pick(rng, 0.01, 0.04)
    share = min(pick(rng, 0.1, 0.2) * strength, 0.6)
    J_x, J_l = share * builder.rig.J_l, (1 - share) * builder.rig.J_l
    k = (2 * np.pi * hz) ** 2 * coupled(J_x, J_l)
    builder.rig = replace(builder.rig, J_l=J_l)
    builder.set(extra=DISC, J_x=J_x, k_x=k, c_x=2 * damping * np.sqrt(k * coupled(J_x, J_l)))
    return {"frequency_hz": hz, "damping_ratio": damping, "share_of_J_l": share}


def coupling(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """An elastic coupling between rotor (with the encoder) and wave generator; softer when stronger."""
    share, damping = pick(rng, 0.3, 0.5), pick(rng, 0.01, 0.04)
    hz = pick(rng, 60.0, 110.0) / np.sqrt(max(strength, 0.05))
    J_x, J_m = share * builder.rig.J_m, (1 - share) * builder.rig.J_m
    k = (2 * np.pi * hz) ** 2 * coupled(J_x, J_m)
    builder.rig = replace(builder.rig, J_m=J_m)
    builder.set(extra=COUPLING, J_x=J_x, k_x=k, c_x=2 * damping * np.sqrt(k * coupled(J_x, J_m)))
    return {"frequency_hz": hz, "damping_ratio": damping, "share_of_J_m": share}


def sensor_shaft(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The torque sensor is a spring with a hub before it."""
    hz, damping = pick(rng, 45.0, 90.0), pick(rng, 0.01, 0.04)
    J_x = min(pick(rng, 0.03, 0.08) * strength, 0.3) * builder.rig.J_l
    k = (2 * np.pi * hz) ** 2 * J_x
    builder.set(extra=SENSOR_SHAFT, J_x=J_x, k_x=k, c_x=2 * damping * np.sqrt(k * J_x))
    return {"frequency_hz": hz, "damping_ratio": damping, "hub_inertia": J_x}


FORMS = (
    Form("torsional_mode", "disc", disc, textbook=True),
    Form("torsional_mode", "coupling", coupling, weakest=0.2, strongest=4.0),
    Form("torsional_mode", "sensor_shaft", sensor_shaft, weakest=0.5),  # weaker is a sensor softer than any
)
