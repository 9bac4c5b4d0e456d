"""What the model leaves in one channel, all runs joined, beside every coordinate it may live in."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from rig.analysis.tracing.fit.equations import Equations, Key
from rig.model.effect import Array

Index = npt.NDArray[np.int64]
"""The bin each row lies in, (n,); −1 in none."""


@dataclass(frozen=True)
class Rest:
    """What is left in one channel, all runs joined: residual over floor, run of each row, and coordinates by name.
    `own_zeros`: whether every run has a zero of its own, as angles and a torque sensor do."""

    e: Array
    run: Array
    at: dict[str, Array]
    dt: float
    own_zeros: bool = True


def rest(eq: Equations, e: Mapping[Key, Array], floors: Mapping[Key, float], channel: str) -> Rest | None:
    """Join the runs of one channel."""
    keys = [k for k in e if k[1] == channel]
    if not keys:
        return None
    made = [_coordinates(eq, k) for k in keys]
    at = {name: np.concatenate([m[name] for m in made]) for name in made[0]}
    run = np.concatenate([np.full(e[k].size, k[0]) for k in keys])
    smooth = eq.runs[keys[0][0]].smoother
    return Rest(np.concatenate([e[k] / floors[k] for k in keys]), run, at, smooth.dt * smooth.step, channel != "M")


def _coordinates(eq: Equations, key: Key) -> dict[str, Array]:
    run, kept = eq.runs[key[0]], eq.rows[key].keep
    rows = [run.smoother.centres(p.t.size) for p in run.pieces]

    def of(name: str) -> Array:
        return np.asarray(np.concatenate([getattr(p, name)[r] for p, r in zip(run.pieces, rows, strict=True)])[kept])

    names = {
        "motor_angle": "theta_m",
        "load_angle": "theta_l",
        "speed": "omega_m",
        "load": "torque",
        "motor_torque": "tau_m",
        "direction": "way",
        "time": "t",
        "temperature": "temperature",
        "torque_rate": "torque_rate",
    }
    return {name: of(column) for name, column in names.items()}
