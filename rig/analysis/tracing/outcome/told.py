"""The parameters of the baseline in words, and what a refit beside the effects did not move, with why."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from rig.analysis.tracing.outcome.honest import ORDER
from rig.model.effect import Parameter

PARAMETERS: Final = {  # symbol, what it is
    "K": ("K", "torsional stiffness, near zero torque"),
    "K_under_load": ("K_L", "torsional stiffness at the largest torque there was"),
    "B_sp": ("B_sp", "damping of the flexspline"),
    "J_m": ("J_m", "inertia, motor side"),
    "B_m": (
        "B_m",
        "viscous friction, motor side and mesh, which no run tells apart: B_m + B_ml·(1 + σ/N) where the torque sensor "
        "reads the spring alone, B_m + B_ml·(1 + σ/N)² where it reads the mesh as well",
    ),
    "B_ml": ("B_ml", "viscous friction of the mesh"),
    "tau_c": ("τ_c", "constant friction, motor side"),
    "tau_0": ("τ_0", "zero of the motor torque"),
    "J_l": ("J_l", "inertia, load side"),
    "B_l": (
        "B_l",
        "viscous friction, load side, and what the mesh does to it: B_l + σ·(N + σ)·B_ml where the torque sensor reads "
        "the spring alone, B_l where it reads the mesh as well; σ = −1 where the mesh takes the difference of both "
        "speeds, 1 where it takes their sum",
    ),
    "tau_cl": ("τ_cl", "constant friction, load side"),
    "tau_l0": ("z", "zero of the torque sensor"),
    "gain": ("g", "share by which the motor torque reads more than the torque sensor"),
    "lag_m": ("t_m", "delay of the motor torque's reading; below 0 it is told before it acts"),
    "lag": ("t_r", "delay of the torque sensor's reading"),  # δ is the skew of a channel
}

EQUATIONS: Final = {  # what is fitted in which equation alone, as long as every sensor is there
    "kinematic error": ("K", "K_under_load", "B_sp"),
    "motor torque": ("J_m", "B_m", "tau_c", "tau_0", "gain", "lag_m"),
    "shaft torque": ("J_l", "B_l", "tau_cl", "tau_l0", "lag"),
}
SAME: Final = 1e-9  # relative: the digits that trace.json has


def meaning(name: str) -> str:
    """What a parameter of the baseline is; "" of one unheard of."""
    if name.startswith(ORDER):
        return f"kinematic error, amplitude of order {name.removeprefix(ORDER)} of the motor angle"
    return PARAMETERS.get(name, (name, ""))[1]


def symbol(name: str) -> str:
    """As a page writes it."""
    if name.startswith(ORDER):
        return f"order {name.removeprefix(ORDER)}"
    return PARAMETERS.get(name, (name, ""))[0]


def unmoved(before: Sequence[Parameter], after: Sequence[Parameter]) -> tuple[str, ...]:
    """Names of the parameters that a refit left as they were to every digit, interval too."""
    found = {p.name: p for p in after}
    return tuple(p.name for p in before if p.name in found and _same(p, found[p.name]))


def why_unmoved(before: Sequence[Parameter], after: Sequence[Parameter], effects: Sequence[str]) -> str:
    """Why they did not move, a sentence for each equation; "" where all moved or nothing was added."""
    still = unmoved(before, after)
    if not still or not effects:
        return "No effect was added, so nothing was fitted again." if still else ""
    said = [
        f"{listed([symbol(n) for n in mine])} {'stands' if len(mine) == 1 else 'stand'} in the equation of the "
        f"{equation} alone, where what was added has no term: the refit could not move "
        f"{'it' if len(mine) == 1 else 'them'}."
        for equation, names in EQUATIONS.items()
        if (mine := [n for n in still if n in names])
    ]
    known = {n for names in EQUATIONS.values() for n in names}
    others = [symbol(n) for n in still if n not in known]
    return " ".join([*said, *([f"{listed(others)} came out of the refit as they were."] if others else [])])


def listed(names: Sequence[str]) -> str:
    """ "a", "a and b", "a, b and c"."""
    return "".join(names) if len(names) < 2 else f"{', '.join(names[:-1])} and {names[-1]}"


def _same(a: Parameter, b: Parameter) -> bool:
    return all(math.isclose(x, y, rel_tol=SAME) for x, y in zip((a.value, *a.ci95), (b.value, *b.ci95), strict=True))
