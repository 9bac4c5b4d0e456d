"""Do all runs count the motor angle from one zero? An encoder that was switched off in between has another one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rig.analysis.findings.collected import pm
from rig.analysis.identify.recording import Recording
from rig.analysis.identify.slow import SLOW
from rig.analysis.kinematic_error.measure import KinematicError, groups_by_speed, measure
from rig.analysis.kinematic_error.profile import Profile, phasors, u_phasors
from rig.analysis.motion.strokes import find_strokes
from rig.analysis.orders.align import Alignment, other_zero
from rig.core.errors import DataError
from rig.core.quantiles import Z95
from rig.core.units import DEG

SEEN = 2  # turns at least


def refuse_other_zeros(runs: Sequence[Recording]) -> None:
    """Raises DataError when a slow run's kinematic error lies elsewhere on the motor angle than that of the first.

    Fitted together they would give one that is too small, and everything that leans on it. Runs that are never slow do
    not show their zero: inertia turns the phase of what they measure.
    """
    slow = [(run, error) for run in runs if (error := _slow_error(run)) is not None]
    if not slow:
        return
    first, reference = slow[0]
    odd = [(run, where) for run, error in slow[1:] if (where := _turned(error.profile, reference.profile)) is not None]
    if odd:
        run, where = odd[0]
        apart = pm(where.fitted / DEG, Z95 * where.u_fitted / DEG, "degrees")
        others = f" and {len(odd) - 1} more" if len(odd) > 1 else ""
        raise DataError(
            f"{run.name}{others} counts the motor angle from another zero than {first.name}: its kinematic error lies "
            f"{apart} further, as after switching the encoder "
            "off; expected one zero: identify the runs of one zero at a time"
        )


def _slow_error(run: Recording) -> KinematicError | None:
    """Of the slowest turns of a run whose load turns too; None where it has none or they are fast."""
    if run.locked:
        return None
    groups = groups_by_speed(run.motion, find_strokes(run.motion))
    if not groups or sum(s.revolutions for s in groups[0]) < SEEN:
        return None
    error = measure(run.source, run.motion, groups[0], slow=True)
    return error if error is not None and error.speed_rpm < SLOW else None


def _turned(error: Profile, reference: Profile) -> Alignment | None:
    """The shift between two slow errors where there is one and it makes them alike; None else."""
    k = min(error.terms, reference.terms)
    seen, expected = phasors(error, k), phasors(reference, k)
    u = np.hypot(u_phasors(error, k), u_phasors(reference, k))
    return other_zero(seen, expected, u)
