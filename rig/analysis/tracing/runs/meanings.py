"""A shaft torque that no sensor read: said, for what was put into it comes out again."""

from __future__ import annotations

from typing import Final

from rig.runfile.run import Run

COMPUTED: Final = ("computed", "calculated", "estimated", "derived", "no shaft sensor", "no sensor", "feed-forward")
"""Words of a column's meaning that say so."""


def computed_torque(run: Run) -> list[str]:
    """A note where the run's own `meaning` of tau_l says that it was not measured; else none."""
    meaning = run.meaning("tau_l") if "tau_l" in run.channels else ""
    if not any(word in meaning.lower() for word in COMPUTED):
        return []
    return [
        f"tau_l is no reading of a shaft sensor but “{meaning}”: weight, inertia and friction that went into it come "
        "out of it again, and stiffness is as good as it is."
    ]
