"""Second looks at a campaign, each at what the first leaves out, where something outside of the equations asks for it.

The first selection stands unless the look finds what it was for, beside all that had a name but for what stood in for
it. To add one: a file here with its question (`wanted`) and its look (`taken`), a line in LOOKS, a
field in runs/look.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from rig.analysis.tracing.fit.search import Found
from rig.analysis.tracing.looks import fast, gain, held_load, late_motor, late_torque, means, narrow, reversals, zeros
from rig.analysis.tracing.runs.campaign import Campaign
from rig.analysis.tracing.selection.selected import Selected

LOOKS = (late_motor, late_torque, reversals, held_load, gain, zeros, means, fast, narrow)


def second_looks(
    selected: Selected, found: Found, campaign: Campaign, hold_out: Sequence[str]
) -> tuple[Selected, Found]:
    """What stands after all of them, in their order."""
    for look in LOOKS:
        if look.wanted(selected):
            selected, found = look.taken(selected, found, campaign, hold_out)
            campaign = _as_read(selected.p.campaign, campaign)
    return selected, found


def _as_read(now: Campaign, before: Campaign) -> Campaign:
    """The campaign that later looks are at: the one in which a look found a torque to be late, or early."""
    late = [(c.runs[0].look.late_torque, c.runs[0].look.late_motor) for c in (now, before)]
    return now if late[0] != late[1] else before
