"""Parameters that the runs want far from what their manifests declare: no effect, and worth a look at the rig."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Parameter

FACTOR: Final = 1.5  # a gear's catalogue stiffness is met to a fifth, an inertia by a drawing to a tenth
WHY: Final = {
    "K": "what is soft in series, a coupling, the torque sensor's shaft, a mount, winds up with the gear",
    "J_m": "couplings and the wave generator turn with the rotor",
    "J_l": "something else hangs on the output",
}


def unlike_declared(found: Sequence[Parameter], runs: Sequence[Recording]) -> list[str]:
    """A sentence for each of `found` whose whole interval is FACTOR and more away from what all `runs` declare."""
    out = []
    for p in found:
        said = {run.declared.get(p.name) for run in runs} if p.name in WHY else set()
        declared = said.pop() if len(said) == 1 else None
        if declared and (p.ci95[0] > FACTOR * declared or 0 < p.ci95[1] < declared / FACTOR):
            out.append(
                f"{p.name} comes out as {p.value:.4g} {p.unit}, {p.value / declared:.2g} times the {declared:.4g} "
                f"{p.unit} that the manifests declare: {WHY[p.name]}, or the declared number is another gear's."
            )
    return out
