"""One channel read later than another [physics D7]: load angle late (textbook), motor angle late, load angle dull."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick


def load_late(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    late = pick(rng, 1.5e-4, 5e-4) * strength
    builder.sensors.late["theta_l"] = late
    return {"late_s": late}


def motor_late(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    late = pick(rng, 1.5e-4, 5e-4) * strength
    builder.sensors.late["theta_m"] = late
    return {"late_s": late}


def load_filtered(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The load angle passes a first-order filter: late by its time constant, and duller."""
    late = pick(rng, 1.5e-4, 5e-4) * strength
    builder.sensors.lag["theta_l"] = late
    return {"late_s": late}


FORMS = (
    Form("channel_time_skew", "load_late", load_late, textbook=True),
    Form("channel_time_skew", "motor_late", motor_late),
    Form("channel_time_skew", "load_filtered", load_filtered),
)
