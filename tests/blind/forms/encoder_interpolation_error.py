"""Orders of an encoder's line count [physics D5]: one per line (textbook), faulty sine pair, motor encoder."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import ANGLE, Builder
from tests.blind.forms.form import Form, Parameters, phase, pick
from tests.blind.sensors import Columns, Context

LOAD_LINES = (3600, 5400, 7200, 9000)  # divisors of 1 296 000 counts: the electronics interpolate the rest


def per_line(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    lines, size, psi = int(rng.choice(LOAD_LINES)), pick(rng, 4e-6, 1e-5) * strength, phase(rng)

    def read(columns: Columns, where: Context) -> None:
        columns["theta_l"] += size * np.sin(lines * columns["theta_l"] - psi)

    builder.sensors.changes.append(read)
    return {"lines": lines, "amplitude_rad": size}


def sine_cosine_faults(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Offsets, unequal gains and a phase that is not 90° (Heydemann): the exact arctangent of the faulty pair."""
    lines = int(rng.choice(LOAD_LINES))
    size = pick(rng, 0.006, 0.015) * strength
    off_s, off_c, gain, skew = size * pick(rng, -4, 4), size * 3, 1 + size * pick(rng, 2, 4), size * pick(rng, -3, 3)

    def read(columns: Columns, where: Context) -> None:
        x = lines * columns["theta_l"]
        seen = np.arctan2(gain * np.sin(x + skew) + off_s, np.cos(x) + off_c)
        columns["theta_l"] += np.angle(np.exp(1j * (seen - x))) / lines

    builder.sensors.changes.append(read)
    return {"lines": lines, "amplitude_rad": 3 * size / lines}


def motor_lines(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A sine-cosine motor encoder of few lines with an error of one and two per line."""
    lines, size = int(rng.choice([64, 128, 256])), pick(rng, 2e-4, 5e-4) * strength
    builder.add("encoder_m", size * (np.sin(lines * ANGLE - phase(rng)) + 0.4 * np.sin(2 * lines * ANGLE - phase(rng))))
    return {"lines": lines, "amplitude_rad": size}


FORMS = (
    Form("encoder_interpolation_error", "per_line", per_line, textbook=True, strongest=5.0),
    Form("encoder_interpolation_error", "sine_cosine_faults", sine_cosine_faults, strongest=5.0),
    Form("encoder_interpolation_error", "motor_lines", motor_lines, strongest=5.0),
)
