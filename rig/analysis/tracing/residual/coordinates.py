"""Coordinates cut into bins: the rest is read bin by bin, so that no form is assumed."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from rig.analysis.tracing.residual.joined import Index, Rest
from rig.analysis.tracing.residual.past import LEAKS, WIDTHS, behind, relaxing, since_turned, slid, summed
from rig.core.units import TURN
from rig.model.effect import Array

BINS = 60  # of a turn: 6°, a few teeth
LEVELS = 24  # of a range
FINER = 4  # times as many: a tooth and a half; 2 % of a range
WAYS = np.geomspace(0.3, 3000.0, 32)  # rad of the motor, a third more each
PERIODS = 8  # of a campaign: more would tell single runs apart, and with them speed, load and direction


def _levels(x: Array, count: int = LEVELS) -> Index:
    good = np.isfinite(x)
    if good.sum() < 100 or np.ptp(x[good]) == 0:
        return np.full(x.size, -1)
    edges = np.unique(np.quantile(x[good], np.linspace(0, 1, count + 1)[1:-1]))
    return np.where(good, np.digitize(x, edges), -1)


def steps(x: Array, count: int = LEVELS) -> Index:
    """Levels as wide as each other: most rows have little load, and a lock test most of the range."""
    good = np.isfinite(x)
    if good.sum() < 100 or np.ptp(x[good]) == 0:
        return np.full(x.size, -1)
    edges = np.linspace(float(x[good].min()), float(x[good].max()), count + 1)[1:-1]
    return np.where(good, np.digitize(x, edges), -1)


def turned(x: Array, bins: int) -> Index:
    """Bins of an angle [rad] that comes back to itself; −1 where it is unknown."""
    good = np.isfinite(x)
    return np.where(good, (np.mod(np.where(good, x, 0.0), TURN) / TURN * bins).astype(int) % bins, -1)


def _branch(r: Rest) -> Index:
    """1 where the torque rises, else 0."""
    return (r.at["torque_rate"] > 0).astype(int)


def both(a: Index, b: Index) -> Index:
    """One index of two; −1 where either has none."""
    return np.where((a >= 0) & (b >= 0), a * (int(b.max(initial=0)) + 1) + b, -1)


def _memories(name: str) -> tuple[Callable[[Rest], Index], ...]:
    """What a torque has been, in each of a few ways."""
    plays = tuple(lambda r, w=w: _levels(behind(r.at[name], r.run, w)) for w in WIDTHS)
    return (*plays, *_leaks(name), lambda r: _levels(summed(r.at[name], r.run, r.dt)))


def _leaks(name: str) -> tuple[Callable[[Rest], Index], ...]:
    """How far it is behind its own past, in a few times: with its sign, and its size forth and back apart."""

    def of(r: Rest, leak: float) -> Index:
        return both(_levels(relaxing(np.abs(r.at[name]), r.run, r.dt, leak)), (r.at["direction"] + 1).astype(int))

    signed = tuple(lambda r, leak=leak: _levels(relaxing(r.at[name], r.run, r.dt, leak)) for leak in LEAKS)
    return signed + tuple(lambda r, leak=leak: of(r, leak) for leak in LEAKS)


def _since_turned(r: Rest) -> Index:
    """Way since the motor last turned back, forth and back apart."""
    way = since_turned(r.at["motor_angle"], r.at["direction"], r.run)
    return both(_ways(way), (r.at["direction"] + 1).astype(int))


def _slid(r: Rest) -> Index:
    """Way since the motor last rested, forth and back apart."""
    way = slid(r.at["motor_angle"], r.at["time"], r.run)
    return both(_ways(way), (r.at["direction"] + 1).astype(int))


def _ways(way: Array) -> Index:
    """Levels of a way [rad], by its logarithm: what wears off does so within some turns of thousands."""
    return np.where(np.isfinite(way), np.digitize(np.abs(way), WAYS), -1)


INDICES: Mapping[str, Callable[[Rest], Index]] = {
    "motor_angle": lambda r: turned(r.at["motor_angle"], BINS),
    "load_angle": lambda r: turned(r.at["load_angle"], 6 * BINS),
    "speed": lambda r: _levels(np.abs(r.at["speed"])),
    "load": lambda r: _levels(r.at["load"]),
    "direction": lambda r: (r.at["direction"] + 1).astype(int),
    "time": lambda r: _levels(r.at["time"], PERIODS),
    "temperature": lambda r: _levels(r.at["temperature"]),
    "memory": lambda r: both(_levels(r.at["load"]), both(_branch(r), (r.at["direction"] + 1).astype(int))),
}
FINE: Sequence[tuple[str, Callable[[Rest], Index]]] = (
    ("motor_angle", lambda r: turned(r.at["motor_angle"], FINER * BINS)),
    ("load_angle", lambda r: turned(r.at["load_angle"], FINER * 6 * BINS)),
    ("load", lambda r: steps(r.at["load"], FINER * LEVELS)),
)
"""The same once more: a dent in a race is narrow, and so are the waves of a sensor's scale."""


def _waves_since_turned(r: Rest) -> Index:
    """The motor's angle, by the way since it last turned back."""
    way = since_turned(r.at["motor_angle"], r.at["direction"], r.run)
    return both(turned(r.at["motor_angle"], BINS), _levels(np.abs(way), PERIODS))


LATE: Sequence[tuple[str, Callable[[Rest], Index]]] = (
    ("memory", _since_turned),
    ("memory", _slid),
    ("memory", _waves_since_turned),
)
"""Asked last: where the motor turned back at one place, or never, it is an angle gone and the time."""
JOINT: Mapping[str, Sequence[Callable[[Rest], Index]]] = {
    "time": (
        lambda r: both(turned(r.at["motor_angle"], BINS), INDICES["time"](r)),
        lambda r: both(_levels(r.at["load"]), INDICES["time"](r)),
        lambda r: both(_levels(np.abs(r.at["speed"])), INDICES["time"](r)),
        lambda r: both(INDICES["direction"](r), INDICES["time"](r)),
    ),
    "temperature": (
        lambda r: both(_levels(r.at["load"]), INDICES["temperature"](r)),
        lambda r: both(INDICES["direction"](r), INDICES["temperature"](r)),
        lambda r: both(turned(r.at["motor_angle"], BINS), _levels(r.at["temperature"], PERIODS)),
        lambda r: both(turned(r.at["load_angle"], BINS), _levels(r.at["temperature"], PERIODS)),
    ),
    "motor_angle": (
        lambda r: both(turned(r.at["motor_angle"], BINS), (r.at["direction"] + 1).astype(int)),
        lambda r: both(turned(r.at["motor_angle"], FINER * BINS), (r.at["direction"] + 1).astype(int)),
    ),
    "load_angle": (lambda r: both(turned(r.at["load_angle"], 2 * BINS), (r.at["direction"] + 1).astype(int)),),
    "speed": (
        lambda r: steps(np.abs(r.at["speed"])),
        lambda r: both(_levels(np.abs(r.at["speed"])), (r.at["direction"] + 1).astype(int)),
    ),
    "load": (
        lambda r: steps(r.at["load"]),
        lambda r: both(_levels(r.at["load"]), (r.at["direction"] + 1).astype(int)),
        lambda r: both(turned(r.at["motor_angle"], BINS), _levels(r.at["load"], PERIODS)),
    ),
    "memory": (*_memories("load"), *_memories("motor_torque"), *_leaks("speed")),
}
"""Coordinates that show only beside another one: what grows with time grows at some angle or load. The key is what is
said of them."""
