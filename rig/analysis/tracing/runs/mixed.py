"""Runs of one folder that may be of two rigs: simulated beside measured ones, and other numbers declared."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.runs.declared import stated
from rig.runfile.run import Run

SAME: Final = 1.01  # times: what two people round differently


def mixed(runs: Sequence[Run], discs: str = "") -> list[str]:
    """What tells that not all of `runs` are of one rig, a sentence each; `discs` is one on their loads, if any."""
    numbers = {name: _numbers(name, runs) for name in ("K", "J_m", "J_l")} | ({"J_l": discs} if discs else {})
    return [*_origins(runs), *(said for said in numbers.values() if said)]


def _origins(runs: Sequence[Run]) -> list[str]:
    simulated = [run.name for run in runs if run.simulated]
    if len(simulated) in (0, len(runs)):
        return []
    return [
        f"{len(simulated)} of {len(runs)} runs are simulated ({', '.join(simulated)[:80]}) and the others are not: "
        "what they differ by is no gear's."
    ]


def _numbers(name: str, runs: Sequence[Run]) -> str:
    """On a number that is declared differently; "" where it is not."""
    found = {run.name: abs(said) for run in runs if (said := stated(run.declared, name, 0.0))}
    if not found:
        return ""
    least, most = min(found, key=found.__getitem__), max(found, key=found.__getitem__)
    if found[most] <= SAME * found[least]:
        return ""
    return (
        f"The manifests declare {name} from {found[least]:.4g} ({least}) to {found[most]:.4g} ({most}): on one rig, in "
        "one assembly, it is one number."
    )
