"""Angles in another unit than rad, or not in the declared ratio: seen run by run, refused where most runs show it.

A kinematic error is some 1e-4 of a motor turn, and wind-up comes and goes: neither makes the travels of both angles go
otherwise than 1:N. Both angles in degrees go as 1:N too: see motion/degrees.py.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from typing import Final

import numpy as np

from rig.analysis.motion.angle import is_another_ratio
from rig.analysis.motion.degrees import DEGREES, STEP, Turning, come_again_in_degrees
from rig.analysis.motion.mistaken import mistaken
from rig.analysis.tracing.runs.recording import Recording
from rig.core.errors import UsageError
from rig.core.units import RPM

ALIKE: Final = 0.01  # how far a slope, or a speed over another, may be from that of degrees
SAME_SPEED: Final = 0.05  # relative
FEWEST: Final = 2  # runs that say what is usual


def odd_angles(run: Recording) -> str | None:
    """What is wrong with the angles of a run that turns freely; None where nothing is."""
    if run.locked or run.procedure == "standstill":
        return None
    return _ratio(run) or _degrees(run)


def faster_by_degrees(runs: Sequence[Recording]) -> dict[str, str]:
    """What is said of runs, by name, that turn 57.3 times as fast as the others of their procedure, most of which turn
    alike: where nobody says speed or counts that is all there is to tell degrees by."""
    said: dict[str, str] = {}
    turn = [run for run in runs if not run.locked and run.procedure != "standstill" and {"t", "theta_m"} <= run.has]
    for run in turn:
        others = [r for r in turn if r.procedure == run.procedure and r is not run]
        usual = max(float(np.median([r.turning for r in others])), 1e-300) if others else np.inf
        like = [r for r in others if abs(r.turning / usual - 1) < SAME_SPEED]
        times = run.turning / usual
        if len(like) >= max(FEWEST, (len(others) + 1) // 2) and abs(times / DEGREES - 1) < ALIKE and not run.speed_rpm:
            said[run.name] = (
                f"the motor turns at {run.turning / RPM:.4g} rpm, {times:.1f} times the {usual / RPM:.4g} rpm of "
                f"{like[0].name} and {len(like) - 1} more: both angles seem to be in degrees, expected rad"
            )
    return said


def refuse_odd_angles(runs: Sequence[Recording], name: str) -> None:
    """Raises UsageError when most of the runs that turn freely have something wrong with their angles.

    A run that turns too little to show a ratio a few per cent off by itself counts with those it agrees with.
    """
    free = [run for run in runs if not run.locked and run.procedure != "standstill"]
    odd = {run.name: said for run in free if (said := odd_angles(run)) is not None}
    slopes = {run.name: slope for run in free if (slope := _slope(run)) is not None}
    shown = [slopes[run.name] for run in free if _ratio(run) is not None]
    usual = float(np.median(shown)) if shown else 1.0
    with_them = {run for run, slope in slopes.items() if abs(slope - usual) < abs(slope - 1)}
    with_them |= _of_one_encoder(free, {run.step_m for run in free if _degrees(run) is not None})
    count = len(with_them | set(odd))
    if odd and 2 * count > len(free):
        first, said = next(iter(odd.items()))
        where = f"in {count} of {len(free)} runs that turn (here {first})" if len(free) > 1 else f"in {first}"
        raise UsageError(f"{name}: {where} {said}")


def _of_one_encoder(free: Sequence[Recording], steps: Set[float]) -> set[str]:
    """Runs whose motor angle moves in one of those `steps`: the same encoder in the same unit. What a slow run in
    degrees turns at is no speed out of reach, so that nothing else says it of it."""
    return {run.name for run in free if any(step and abs(run.step_m / step - 1) < STEP for step in steps)}


def _slope(run: Recording) -> float | None:
    """Δθ_l over Δθ_m/N, 1 when both are what they say; None where an angle is missing."""
    if not {"theta_m", "theta_l"} <= run.has:
        return None
    went = [(p.theta_m - p.theta_m.mean(), p.theta_l - p.theta_l.mean()) for p in run.pieces]
    return run.ratio * float(sum(m @ x for m, x in went)) / max(float(sum(m @ m for m, _ in went)), 1e-300)


def _ratio(run: Recording) -> str | None:
    slope = _slope(run)
    travel = max(float(np.ptp(p.theta_m)) for p in run.pieces) / run.ratio
    if slope is None or not is_another_ratio(slope, travel):
        return None
    return f"θ_l goes {slope:.4g} of θ_m/{run.ratio:g}, expected 1: {_reason(run.ratio, slope)}"


def _reason(ratio: float, slope: float) -> str:
    """What would make θ_l go `slope` of θ_m/`ratio`."""
    if abs(slope) < 1e-6:
        return "θ_l does not move"
    if why := mistaken(ratio, ratio / slope):
        return why
    return f"θ_m/θ_l is {ratio / slope:.4g}, the declared gear.ratio {ratio:g}, or an angle is in another unit than rad"


def _degrees(run: Recording) -> str | None:
    if "theta_m" not in run.has:
        return None
    count = 2 * np.pi / run.counts_m if run.counts_m else 0.0
    turning = run.turning / RPM if "t" in run.has else None
    return Turning(run.step_m, count, turning, run.speed_rpm, run.ratio, _waves(run)).in_degrees


def _waves(run: Recording) -> str | None:
    """What the waves of both angles say, where no count is declared that would."""
    if run.counts_m or "theta_l" not in run.has:
        return None
    theta_m, theta_l = (np.concatenate([getattr(p, name) for p in run.pieces]) for name in ("theta_m", "theta_l"))
    return come_again_in_degrees(theta_m, theta_l, run.ratio)
