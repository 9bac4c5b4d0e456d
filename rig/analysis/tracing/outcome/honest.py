"""The baseline's parameters as far as these runs tell them: no order beyond their rows, no interval narrower than what
two parameters that go together leave open, and a word on what is not determined.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import ORDERS
from rig.analysis.tracing.runs.cannot import highest_order, one_speed
from rig.analysis.tracing.runs.recording import Recording
from rig.model.effect import Parameter

ORDER: Final = "theta_p_order_"
POSITIVE: Final = ("K", "J_m", "B_m", "tau_c", "J_l", "B_l", "tau_cl", "B_sp")
"""What no gear has less than none of."""
NOISE: Final = 30.0  # width of an interval over its value, from which the value says nothing


def honest(found: Sequence[Parameter], runs: Sequence[Recording]) -> tuple[Parameter, ...]:
    """`found` of a fit to `runs`."""
    most = highest_order(runs)
    kept = [p for p in found if not p.name.startswith(ORDER) or int(p.name.removeprefix(ORDER)) <= most]
    return tuple(_at_one_speed(kept, runs) if one_speed(runs) else kept)


def _at_one_speed(found: Sequence[Parameter], runs: Sequence[Recording]) -> list[Parameter]:
    """τ_c + B_m·ω_m and τ_cl + B_l·ω_l are all that one speed tells: each of two may be none of it, or all."""
    speed = float(np.mean([run.turning for run in runs if not run.locked]))
    named = {p.name: p for p in found}
    for constant, drag, omega in (("tau_c", "B_m", speed), ("tau_cl", "B_l", speed / runs[0].ratio)):
        if constant in named and drag in named:
            c, b = named[constant], named[drag]
            whole = max(c.value + b.value * omega, 0.0)
            named |= {constant: _wide(c, whole), drag: _wide(b, whole / omega)}
    return list(named.values())


def _wide(p: Parameter, most: float) -> Parameter:
    return replace(p, ci95=(min(p.ci95[0], 0.0), max(p.ci95[1], most)))


def left_open(found: Sequence[Parameter]) -> tuple[Parameter, ...]:
    """Those of which no gear has less than none, and whose interval goes down to it."""
    return tuple(p for p in found if p.name in POSITIVE and p.ci95[0] <= 0)


def in_words(found: Sequence[Parameter]) -> str:
    """Each with its value and interval; without numbers where they would be nothing but noise."""
    return ", ".join(f"{p.name} ({_said(p)})" for p in found)


def _said(p: Parameter) -> str:
    low, high = p.ci95
    if not high - low < NOISE * abs(p.value):
        return "not even its order of magnitude"
    value, least, most = (f"{float(f'{x:.3g}'):.10g}" for x in (p.value, low, high))
    return f"{value} {p.unit}, 95 % {least} to {most}"


def not_told(found: Sequence[Parameter], runs: Sequence[Recording]) -> list[str]:
    """What `found` of a fit to `runs` leaves open, one sentence each."""
    out = []
    most = highest_order(runs)
    if most < ORDERS and any(p.name.startswith(ORDER) for p in found):
        out.append(
            f"No run turns slowly enough for its rows to show orders above {most} of the kinematic error: they were "
            "fitted, for what they take from the others, and are not given."
        )
    # B_sp is what is left of a lag, which a filter of either channel makes of either sign
    below = [p for p in left_open(found) if p.ci95[1] < 0 and p.name != "B_sp"]
    if below:
        out.append(
            f"{in_words(below)} came out below zero, as in no gear: something takes its place in these runs, and what "
            "is added to it leans on that."
        )
    if left := [p for p in left_open(found) if p not in below]:
        out.append(
            f"The fitted runs do not determine {in_words(left)}: the interval reaches zero, and no gear has nothing of "
            "it."
        )
    return out
