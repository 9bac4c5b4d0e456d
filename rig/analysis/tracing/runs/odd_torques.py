"""A torque that one run reads otherwise than the others do: a sensor that hung, another unit, the other sign.

Such a run makes repeats differ by more than any effect does: the floor is then what is wrong with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.floor.repeats import alike
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Array

TORQUES: Final = {"tau_m": "τ_m", "tau_l": "τ_l"}
UNIT: Final = 20.0  # times what repeats read: friction that warms away halves, and the next unit is 100 or 1000
MOST: Final = 0.8  # of the runs that turn freely: the sign they agree in is right


def odd_torques(run: Recording, runs: Sequence[Recording]) -> str | None:
    """What is wrong with a torque of `run` beside that of the others; None where nothing is, or nothing tells."""
    if run.procedure == "standstill":
        return None
    for channel, words in TORQUES.items():
        others = [r for r in runs if r is not run and r.locked is run.locked and channel in r.has]
        others = [r for r in others if r.procedure != "standstill"]
        if channel in run.has and others:
            said = _stuck(run, others, channel) or _unit(run, others, channel) or _sign(run, others, channel)
            if said:
                return said.format(words)
    return None


def _stuck(run: Recording, others: Sequence[Recording], channel: str) -> str | None:
    x = _read(run, channel)
    if np.ptp(x) > 0 or sum(np.ptp(_read(r, channel)) > 0 for r in others) <= len(others) / 2:
        return None
    return f"its {{}} is {x[0]:.4g} N·m throughout, that of other runs moves: the sensor hung, or was not connected"


def _unit(run: Recording, others: Sequence[Recording], channel: str) -> str | None:
    """Where all repeats read so much less or more, and are nearer to what all runs read."""
    like = [_size(r, channel) for r in others if alike(run, r)]
    mine, usual = _size(run, channel), float(np.median([_size(r, channel) for r in others]))
    if not like or min(mine, usual, *like) <= 0:
        return None
    ratios = np.log(mine / np.array(like))
    further = abs(np.log(mine / usual)) > max(abs(np.log(size / usual)) for size in like)
    if not further or not (ratios.min() > np.log(UNIT) or ratios.max() < -np.log(UNIT)):
        return None
    times = float(np.exp(np.median(ratios)))
    said = f"{times:.0f} times" if times > 1 else f"one {1 / times:.0f}th of"
    return f"its {{}} is {said} that of its repeats, as if in another unit"


def _sign(run: Recording, others: Sequence[Recording], channel: str) -> str | None:
    """Where it takes what its repeats and most other runs give, the motor against its friction."""
    like = [_power(r, channel) for r in others if alike(run, r)]
    mine, all_ = _power(run, channel), np.array([_power(r, channel) for r in others])
    if run.locked or not like or float(np.mean(all_ * mine < 0)) < MOST:
        return None
    if not all(0.5 < -mine / power < 2.0 for power in like if power) or not all(like):
        return None
    return "its {} has the other sign than that of its repeats"


def _read(run: Recording, channel: str) -> Array:
    return np.concatenate([getattr(piece, channel) for piece in run.pieces])


def _size(run: Recording, channel: str) -> float:
    """RMS, N·m."""
    return float(np.sqrt(np.nanmean(_read(run, channel) ** 2)))


def _power(run: Recording, channel: str) -> float:
    """Mean of torque times the motor's speed, W: of what rubs it is above zero."""
    omega = np.concatenate([piece.omega_m for piece in run.pieces])
    return float(np.nanmean(_read(run, channel) * omega))
