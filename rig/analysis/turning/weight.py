"""What hangs on the output by the torque sensor, beside what the manifest says: a run is not judged by it, but told."""

from __future__ import annotations

import numpy as np

from rig.analysis.findings.result import Array
from rig.analysis.motion.source import Source
from rig.analysis.motion.strokes import Stroke
from rig.core.numbers import number

SHARE = 0.05  # of a weight: masses, pulley radius, gain of the sensor
ZERO = 0.5  # N·m: sensors that nobody tared read as much with nothing on them


def other_weight(run: Source, strokes: list[Stroke], tau_l: Array | None) -> str:
    """That the mean of both directions is not what is said to hang there; "" where it is, or one direction is missing.

    Friction turns its sign with the direction, and a weight does not.
    """
    ways = [_mean(tau_l, [s for s in strokes if s.direction == way]) for way in (1, -1)]
    declared = number(run.conditions.get("tau_ext"), 0.0)
    seen = -sum(ways) / 2
    if run.conditions.get("output_locked") or not is_another(seen, declared):
        return ""
    said = "the manifest says nothing of it"
    if run.conditions.get("tau_ext") is not None:
        said = f"the manifest says {declared:+g} N·m" if declared else "the manifest says 0 N·m"
    return (
        f"What hangs on the output: the torque sensor shows {seen:+.2f} N·m in the mean of both directions (positive "
        f"drives the load forward), {said}: a weight that nobody declared, gravity of a load off its axis, a sensor "
        "that was not tared, or another unit of its torque; this run cannot say which."
    )


def is_another(seen: float, declared: float) -> bool:
    """Whether a weight that a torque sensor shows is not the one that is said to hang there, N·m; NaN is not."""
    return bool(abs(seen - declared) > SHARE * abs(declared) + ZERO)


def _mean(tau_l: Array | None, strokes: list[Stroke]) -> float:
    """N·m over the whole turns of these strokes; NaN without any, or without a sensor."""
    if tau_l is None or not strokes:
        return float("nan")
    parts = [tau_l[s.edges[0] : s.edges[-1]] for s in strokes]
    sums = [(float(np.nansum(p)), int(np.isfinite(p).sum())) for p in parts]
    count = sum(n for _, n in sums)
    return sum(total for total, _ in sums) / count if count else float("nan")
