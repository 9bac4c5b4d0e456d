"""Torques of a run beside what the bench in its folder can measure and give."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from rig.core.numbers import number
from rig.core.rows import stretches
from rig.report.numbers import plain

if TYPE_CHECKING:
    from rig.runfile.run import Run

BEYOND = 1.5  # times what is declared: an overload or an overshoot stays below
SHARE = 1e-3  # of the rows: fewer are single wrong readings


class Declared(NamedTuple):
    """What a bench file says of a torque."""

    channel: str
    section: str
    key: str
    words: str


DECLARED = (
    Declared("tau_l", "torque_sensor", "range", "the torque sensor's range"),
    Declared("tau_m", "motor", "torque_limit", "the motor's limit"),
)


def beyond_ranges(run: Run, bench: Mapping[str, Any]) -> str:
    """Says which torque of `run` is more than `bench`, the run's resolved configuration, lets it be; "" when none is
    or the bench says nothing, as that of a run another logger made."""
    return " ".join(said for one in DECLARED if (said := _beyond(run, one, bench)))


def _beyond(run: Run, one: Declared, bench: Mapping[str, Any]) -> str:
    most, torque = _value(bench, one), run.column(one.channel)
    if torque is None or not most > 0.0:
        return ""
    rows = beyond = 0
    largest = 0.0  # N·m
    for some in stretches(torque.size):
        size = np.abs(torque[some])
        size = size[np.isfinite(size)]
        rows, beyond = rows + size.size, beyond + int(np.count_nonzero(size > BEYOND * most))
        largest = max(largest, float(size.max(initial=0.0)))
    if not beyond > SHARE * rows:
        return ""
    return (
        f"{one.channel} reaches {plain(largest)} N·m, {one.words} is {most:g} N·m ({one.section}.{one.key} "
        "of the bench beside it): another unit than N·m?"
    )


def _value(bench: Mapping[str, Any], one: Declared) -> float:
    section = bench.get(one.section)
    said = section.get(one.key) if isinstance(section, Mapping) else None
    return number(said.get("value") if isinstance(said, Mapping) else said)
