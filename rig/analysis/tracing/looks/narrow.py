"""At slow rows: where a reading is made of another one's acceleration, and that is mostly noise.

A load angle that nobody read is the motor's less the wind-up, a shaft torque the inertia times an acceleration, and the
balance has the second derivative of it: at f times the resonance of the load its noise counts f² times. A spring and an
inertia that are fitted to that come out too stiff and too small, and what they leave is no floor's. Below half the
resonance the reading itself is most of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.prepared import prepare
from rig.analysis.tracing.runs.campaign import Campaign, read_again
from rig.analysis.tracing.searched import searched
from rig.analysis.tracing.selection.confounders import CONFOUNDERS
from rig.analysis.tracing.selection.hidden import hidden
from rig.analysis.tracing.selection.selected import Selected
from rig.core.errors import UsageError
from rig.core.units import TURN
from rig.model.linear import held_frequency

READ: Final = frozenset({"theta_m", "theta_l", "tau_l"})
BELOW: Final = 0.5  # of the resonance
SLOWEST: Final = 3.0  # Hz


def wanted(selected: Selected) -> bool:
    """Whether much is left of runs in which an angle or the shaft torque was not read, and a time was."""
    turning = [run for run in selected.fitted_runs if not run.locked]
    unread = [run for run in turning if "t" in run.has and not run.has >= READ]
    return selected.loud and bool(turning) and len(unread) == len(turning)


def taken(so_far: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]) -> tuple[Selected, Found]:
    """The whole search again through a lower low-pass. It counts where that leaves nothing, hides nothing, and all that
    had a name of the library has it still."""
    gear = so_far.solution.design.eq.runs[0].gear
    hz = max(BELOW * held_frequency(gear.K, gear.J_l) / TURN, SLOWEST)
    lower = hz < so_far.fitted_runs[0].smoother.sigma_hz
    if not lower or (again := read_again(so_far.p.campaign, narrow=hz)) is None:
        return so_far, found
    try:
        other, ranked = searched(prepare(again, hold_out))
    except UsageError:  # too few rows, or an inertia below nothing: what was told stands as well
        return so_far, found
    named = so_far.names - CONFOUNDERS.keys()
    counts = not other.loud and other.names >= named and _is_all(other)
    return (other, ranked) if counts else (so_far, found)


def _is_all(selected: Selected) -> bool:
    """Whether nothing is hidden in its floor either: that was told better by all there is to compare."""
    p, s = selected.p, selected.solution
    return hidden(p, s, p.held_out.residuals(s, selected.held), p.floors) is None
