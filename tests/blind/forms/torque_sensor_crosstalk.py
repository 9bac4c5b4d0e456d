"""Once or twice per output turn in the torque sensor alone [physics E5]: once (textbook), both, bending by the load."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def once(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    size, psi = pick(rng, 0.08, 0.25) * strength, phase(rng)

    def read(columns: Columns, where: Context) -> None:
        columns["tau_l"] += size * np.cos(columns["theta_l"] - psi)

    builder.sensors.changes.append(read)
    return {"torque_1_Nm": size, "phase_rad": psi}


def both(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    one, two = (pick(rng, 0.06, 0.2) * strength for _ in range(2))
    psi, phi = phase(rng), phase(rng)

    def read(columns: Columns, where: Context) -> None:
        columns["tau_l"] += one * np.cos(columns["theta_l"] - psi) + two * np.cos(2 * columns["theta_l"] - phi)

    builder.sensors.changes.append(read)
    return {"torque_1_Nm": one, "torque_2_Nm": two}


def triangle_wave(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A bent shaft between two bearings: once per turn, with a third order from the bearing's clearance."""
    size, psi = pick(rng, 0.08, 0.25) * strength, phase(rng)

    def read(columns: Columns, where: Context) -> None:
        x = columns["theta_l"] - psi
        columns["tau_l"] += size * (np.cos(x) + np.cos(3 * x) / 9)

    builder.sensors.changes.append(read)
    return {"torque_1_Nm": size, "phase_rad": psi}


FORMS = (
    Form("torque_sensor_crosstalk", "once", once, textbook=True),
    Form("torque_sensor_crosstalk", "both", both),
    Form("torque_sensor_crosstalk", "triangle_wave", triangle_wave),
)
