"""A permanent step in one encoder [physics D8]: load encoder (textbook), a random walk, motor encoder, at speed, at a
scratch."""

from __future__ import annotations

import numpy as np

from tests.blind.builder import Builder
from tests.blind.forms.form import Form, Parameters, pick
from tests.blind.sensors import LOAD_COUNTS, MOTOR_COUNTS, Columns, Context

LOAD_COUNT, MOTOR_COUNT = 2 * np.pi / LOAD_COUNTS, 2 * np.pi / MOTOR_COUNTS


def stairs(rng: np.random.Generator, n: int, events: int, counts: int) -> np.ndarray:
    """A step of `counts` at each of `events` rows."""
    out = np.zeros(n)
    for at in rng.integers(n // 10, 9 * n // 10, events):
        out[at:] += counts
    return out


def load_steps(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """In two runs of three, once: the count falls behind and stays there till the next homing."""
    counts = -max(round(pick(rng, 8, 20) * strength), 2)

    def read(columns: Columns, where: Context) -> None:
        if where.name != "standstill" and where.rng.random() < 0.67:
            columns["theta_l"] += stairs(where.rng, len(columns["t"]), 1, counts) * LOAD_COUNT

    builder.sensors.changes.append(read)
    return {"counts": counts, "count_rad": LOAD_COUNT}


def random_walk(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """Many small losses and gains, more often the faster the disc turns: about one per 40 output degrees."""
    counts, per_rad = max(round(pick(rng, 3, 8) * strength), 1), pick(rng, 1.0, 2.0)

    def read(columns: Columns, where: Context) -> None:
        travel = float(np.sum(np.abs(np.diff(columns["theta_l"]))))
        n, walk = len(columns["t"]), np.zeros(len(columns["t"]))
        if where.name != "standstill":
            for at in where.rng.integers(0, n, where.rng.poisson(per_rad * travel)):
                walk[at:] += counts * where.rng.choice([-1, 1, 2])
        columns["theta_l"] += walk * LOAD_COUNT

    builder.sensors.changes.append(read)
    return {"counts": counts, "events_per_rad": per_rad}


def motor_steps(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The motor encoder loses counts once in every second run; the controller follows what it reads."""
    counts = -max(round(pick(rng, 20, 60) * strength), 3)

    def steps(name: str, n: int, chance: np.random.Generator) -> np.ndarray:
        if name == "standstill" or chance.random() < 0.5:
            return np.zeros(n)
        return stairs(chance, n, 1, counts) * MOTOR_COUNT

    builder.sensors.motor_steps = steps
    return {"counts": counts, "count_rad": MOTOR_COUNT}


def at_speed(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """The counter of the load falls behind while the disc turns fast, in groups, several times a run."""
    counts, past = -max(round(pick(rng, 4, 12) * strength), 1), pick(rng, 0.3, 0.5)

    def read(columns: Columns, where: Context) -> None:
        speed = abs(columns["theta_l"][-1] - columns["theta_l"][0]) / columns["t"][-1]
        if speed > past:
            columns["theta_l"] += stairs(where.rng, len(columns["t"]), where.rng.integers(1, 5), counts) * LOAD_COUNT

    builder.sensors.changes.append(read)
    return {"counts": counts, "past_rad_s": past}


def scratch(builder: Builder, rng: np.random.Generator, strength: float) -> Parameters:
    """A scratch on the load encoder's disc: counts are lost when it is passed one way, and kept on the way back."""
    counts, way = -max(round(pick(rng, 8, 20) * strength), 2), float(rng.choice([-1.0, 1.0]))
    place = float(rng.uniform(-0.3, 0.3))  # rad, within what slow runs pass

    def read(columns: Columns, where: Context) -> None:
        turn = np.floor(way * (columns["theta_l"] - place) / (2 * np.pi))
        passed = np.maximum(np.diff(turn, prepend=turn[0]), 0.0)
        columns["theta_l"] += counts * LOAD_COUNT * np.cumsum(passed)

    builder.sensors.changes.append(read)
    return {"counts": counts, "place_rad": place, "way": way}


FORMS = (
    Form("missed_counts", "load_steps", load_steps, textbook=True, weakest=0.2, strongest=12.0),
    Form("missed_counts", "random_walk", random_walk, weakest=0.2, strongest=8.0),
    Form("missed_counts", "motor_steps", motor_steps, weakest=0.2, strongest=12.0),
    Form("missed_counts", "at_speed", at_speed, weakest=0.2, strongest=12.0),
    Form("missed_counts", "scratch", scratch, weakest=0.2, strongest=12.0),
)
