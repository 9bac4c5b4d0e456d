"""Where a column at one of an effect's ports shows: in which equations of the rig, and which of its rates by time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Final

import numpy as np

from rig.analysis.tracing.runs.smoothing import Smoother
from rig.model.effect import Array, Port, Signals

HIGHEST: Final = 3  # derivative the low-pass makes


Mark = tuple[str, Array, int]
"""Channel, column (n, k) before the low-pass, and which derivative of it by time shows there."""


def _motor_torque(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", c, 0


def _load_torque(c: Array, s: Signals) -> Iterator[Mark]:
    yield "L", c, 0


def _kinematic_error(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", c, 0


def _lever(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", -s.torque[:, None] * c, 0


def _reads_theta_m(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", s.lever[:, None] * c, 0
    yield "M", -s.gear.J_m * c, 2
    yield "M", -s.gear.B_m * c, 1  # of an order 1 at 100 rpm a seventh of that, a quarter of a period later
    yield "M", (np.nan_to_num(s.torque) * s.series_bend)[:, None] * c, 0  # θ̃_p′ is read at another angle


def _reads_theta_l(c: Array, s: Signals) -> Iterator[Mark]:
    yield "A", -c, 0
    yield "L", -s.gear.J_l * c, 2


def _reads_tau_m(c: Array, s: Signals) -> Iterator[Mark]:
    yield "M", c, 0


def _reads_tau_l(c: Array, s: Signals) -> Iterator[Mark]:
    k = s.gear.K
    yield "A", -c / k, 0
    yield "A", s.gear.B_sp / k**2 * c, 1
    yield "M", -s.lever[:, None] * c, 0
    yield "L", c, 0


FOOTPRINTS: Final[Mapping[Port, Callable[[Array, Signals], Iterator[Mark]]]] = {
    Port.MOTOR_TORQUE: _motor_torque,
    Port.LOAD_TORQUE: _load_torque,
    Port.KINEMATIC_ERROR: _kinematic_error,
    Port.WIND_UP: _kinematic_error,
    Port.LEVER: _lever,
    Port.READS_THETA_M: _reads_theta_m,
    Port.READS_THETA_L: _reads_theta_l,
    Port.READS_TAU_M: _reads_tau_m,
    Port.READS_TAU_L: _reads_tau_l,
}


def footprint(
    ports: Mapping[Port, Array],
    s: Signals,
    f: Smoother,
    has: frozenset[str],
    held_load: bool = False,
    is_wound: bool = False,
) -> dict[str, Array]:
    """Columns at ports (n, k) → columns in channels (rows, k) of a run that measured the channels `has`; in A those of
    the load angle alone where `held_load` says so. Where the torque is that of the wind-up, `is_wound`, the motor has
    to hold what A says."""
    out: dict[str, Array] = {}
    for port, columns in ports.items():
        for first in FOOTPRINTS[port](columns, s):
            for channel, column, order in _passed_on(first, s, has, is_wound):
                made = f.of(channel)(column, order)
                out[channel] = out[channel] + made if channel in out else made
    if held_load and "A" in out:
        out["A"] = f(-ports[Port.READS_THETA_L]) if Port.READS_THETA_L in ports else np.zeros_like(out["A"])
    return out | ({"R": out["M"]} if "M" in out else {})


def _passed_on(first: Mark, s: Signals, has: frozenset[str], is_wound: bool) -> Iterator[Mark]:
    """A column, and where else it shows for want of a sensor; a fourth derivative would be noise alone.

    Without time a derivative has no size that runs could share.
    """
    channel, column, order = first
    if order and "t" not in has:
        return
    yield first
    if is_wound:
        if channel == "A":
            yield "M", -s.gear.K * s.lever[:, None] * column, order
        return  # the clamp takes what acts on the load
    if channel == "A" and "t" in has and order < HIGHEST - 1:
        if "theta_l" not in has:
            yield from _passed_on(("L", -s.gear.J_l * column, order + 2), s, has, is_wound)
        if "theta_m" not in has:
            yield "M", s.gear.J_m * s.ratio * column, order + 2
    if channel == "L" and "tau_l" not in has:
        yield "A", column / s.gear.K, order
        if order < HIGHEST:
            yield "A", -s.gear.B_sp / s.gear.K**2 * column, order + 1
        yield "M", s.lever[:, None] * column, order
