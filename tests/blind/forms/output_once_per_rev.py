"""Once per output turn in angle [physics D1, C4]: encoder eccentricity (textbook), with ellipticity, true runout."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def eccentric(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    ratio, psi = pick(rng, 4e-5, 1.2e-4) * strength, phase(rng)

    def read(columns: Columns, where: Context) -> None:
        angle = columns["theta_l"] - psi
        columns["theta_l"] += np.arctan2(ratio * np.sin(angle), 1 - ratio * np.cos(angle))

    builder.sensors.changes.append(read)
    return {"amplitude_rad": ratio, "phase_rad": psi}


def with_ellipticity(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    one, psi, phi = pick(rng, 4e-5, 1.2e-4) * strength, phase(rng), phase(rng)
    two = 0.2 * one

    def read(columns: Columns, where: Context) -> None:
        angle = columns["theta_l"].copy()
        columns["theta_l"] += one * np.sin(angle - psi) + two * np.sin(2 * angle - phi)

    builder.sensors.changes.append(read)
    return {"amplitude_rad": one, "amplitude_2_rad": two, "phase_rad": psi}


def runout(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The flexspline itself turns unevenly: the error is real and loads the spring."""
    size, psi = pick(rng, 4e-5, 1.2e-4) * strength, phase(rng)
    builder.add("p_out", size * np.cos(ANGLE - psi))
    return {"amplitude_rad": size, "phase_rad": psi}


FORMS = (
    Form("output_once_per_rev", "eccentric", eccentric, textbook=True),
    Form("output_once_per_rev", "with_ellipticity", with_ellipticity),
    Form("output_once_per_rev", "runout", runout),
)
