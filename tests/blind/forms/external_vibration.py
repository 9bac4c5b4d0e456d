"""Fixed frequency whatever the speed [physics E7]: sine on the load (textbook), two lines that swell, shaken head,
one that starts and stops."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context


def sine(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    hz, size, psi = pick(rng, 5.0, 48.0), pick(rng, 0.15, 0.5) * strength, phase(rng)
    builder.load_waves.append(lambda t: size * np.sin(2 * np.pi * hz * t + psi))
    return {"frequency_hz": hz, "torque_Nm": size}


def two_lines(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    hz, size, slow = pick(rng, 6.0, 30.0), pick(rng, 0.15, 0.5) * strength, pick(rng, 0.02, 0.1)
    psi, phi = phase(rng), phase(rng)

    def wave(t: np.ndarray) -> np.ndarray:
        swell = 1 + 0.3 * np.sin(2 * np.pi * slow * t)
        return size * swell * (np.sin(2 * np.pi * hz * t + psi) + 0.4 * np.sin(4 * np.pi * hz * t + phi))

    builder.load_waves.append(wave)
    return {"frequency_hz": hz, "torque_Nm": size}


def shaken_head(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The load encoder's read head shakes: the angle shows it, no torque does."""
    hz, size, psi = pick(rng, 8.0, 48.0), pick(rng, 5e-6, 1.5e-5) * strength, phase(rng)

    def read(columns: Columns, where: Context) -> None:
        columns["theta_l"] += size * np.sin(2 * np.pi * hz * (columns["t"] + where.start_s) + psi)

    builder.sensors.changes.append(read)
    return {"frequency_hz": hz, "amplitude_rad": size}


def starts_and_stops(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A compressor that runs for a minute or two, then rests as long."""
    hz, size, turn = pick(rng, 6.0, 40.0), pick(rng, 0.2, 0.6) * strength, pick(rng, 100.0, 300.0)

    def wave(t: np.ndarray) -> np.ndarray:
        runs = 0.5 + 0.5 * np.tanh(20 * np.sin(2 * np.pi * t / turn))
        return size * runs * np.sin(2 * np.pi * hz * t)

    builder.load_waves.append(wave)
    return {"frequency_hz": hz, "torque_Nm": size, "turn_s": turn}


FORMS = (
    Form("external_vibration", "sine", sine, textbook=True),
    Form("external_vibration", "two_lines", two_lines),
    Form("external_vibration", "shaken_head", shaken_head),
    Form("external_vibration", "starts_and_stops", starts_and_stops),
)
