"""Rivals of a named effect, and the run that would decide between them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rig.analysis.tracing.result import NextRun
from rig.analysis.tracing.search import Found
from rig.analysis.tracing.thresholds import CLOSE

if TYPE_CHECKING:
    from rig.analysis.tracing.trace import Prepared


def deciding(p: Prepared, names: Sequence[str], found: Found) -> tuple[tuple[str, ...], NextRun | None]:
    """Effects that alone would have done as well as the first one named, and the cheapest run that tells them apart."""
    best = next((r for r in found.ranking if r.term.name == names[0]), None)
    if best is None or len(names) > 1:
        return (), None
    close = [r for r in found.ranking if r.term.name not in names and r.evidence > CLOSE * best.evidence]
    rivals = tuple(r.term.name for r in close)
    if not rivals:
        return (), None
    pair = {names[0], *rivals}
    for members, procedure, conditions, why in DECIDERS:
        if len(members & pair) >= 2:
            return rivals, NextRun(procedure, conditions, f"separates {' from '.join(sorted(pair))}: {why}")
    return rivals, NextRun("constant_torque", {"speed_rpm": 500.0}, f"separates {' from '.join(sorted(pair))} by speed")


DECIDERS: Sequence[tuple[frozenset[str], str, dict[str, float | bool | str], str]] = (
    (
        frozenset({"thermal_friction_drift", "quadratic_drag", "stribeck_friction"}),
        "friction",
        {"speeds_rpm": "15,30,60,120,200,310,400,500", "output_deg": 4.0, "breakaways": 1},
        "every speed from creep to fast within three minutes, rising and falling: at two or three speeds, minutes "
        "apart, falling friction, drag and warming bend the same curve",
    ),
    (
        frozenset({"nonlinear_stiffness", "hysteretic_stiffness", "lost_motion"}),
        "stiffness_lock",
        {"output_locked": True},
        "nested amplitudes show whether the branches meet",
    ),
    (
        frozenset({"output_once_per_rev", "torque_sensor_crosstalk", "gravity_unbalance"}),
        "constant_torque",
        {"speed_rpm": 400.0},
        "a real angle error makes torque when it turns fast",
    ),
)
