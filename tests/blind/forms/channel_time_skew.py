"""One channel read later than another [physics D7]: load angle late (textbook), motor angle late, load angle dull, a
delay between two clocks."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import Columns, Context, delayed


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


def between_clocks(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Two clocks run apart: the load angle is read later and later, by up to one period of the slower one, and then at
    once again."""
    most, beat = pick(rng, 3e-4, 1e-3) * strength, pick(rng, 1.0, 4.0)

    def read(columns: Columns, where: Context) -> None:
        late = most * np.mod((where.start_s + columns["t"]) / beat, 1.0)
        columns["theta_l"] = delayed(columns["t"], columns["theta_l"], columns["t"] - late)

    builder.sensors.changes.append(read)
    return {"most_s": most, "beat_s": beat}


FORMS = (
    Form("channel_time_skew", "load_late", load_late, textbook=True),
    Form("channel_time_skew", "motor_late", motor_late),
    Form("channel_time_skew", "load_filtered", load_filtered),
    Form("channel_time_skew", "between_clocks", between_clocks),
)
