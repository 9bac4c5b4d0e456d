"""Effects that take the place of what the gear has: a name for its spring, or for an inertia, is none that it lacks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from rig.analysis.tracing.fit.channels import INDEX
from rig.analysis.tracing.fit.covariance import covariance
from rig.analysis.tracing.fit.equations import acting
from rig.analysis.tracing.fit.model import UNSEEN, Design, Solution, fit
from rig.analysis.tracing.fit.search import reduced
from rig.analysis.tracing.floor.own import Own
from rig.analysis.tracing.floor.vibration import VIBRATION
from rig.analysis.tracing.thresholds import KNOWN
from rig.core.quantiles import Z95
from rig.model.effect import Parameter, Port
from rig.model.effects.motor_encoder_eccentricity import MotorEncoderEccentricity

INERTIAS: Final = ("J_m", "J_l")
FRICTIONS: Final = ("tau_c", "B_m")
FREQUENCY: Final = "frequency"
SAME: Final = 0.02  # relative, of two frequencies: a resonance damped by a tenth is known to less than that


def instead_of_the_gear(s: Solution) -> list[str]:
    """Effects in the place of what every gear has: of its spring, or of an inertia; or that need an error of its own to
    hide them, as none has."""
    return instead_of_the_spring(s) or of_a_spring_unseen(s) or instead_of_an_inertia(s) or hidden_by_the_gear(s)


def instead_of_the_spring(s: Solution) -> list[str]:
    """Effects in angle beside which the stiffness is not known any more, as it is without them: under a torque that
    goes with the angle, as an arm's weight does, they and the spring are one wave."""
    if not s.design.terms or _is_stiff(s):
        return []
    return [
        name for name, mine in _by_name(s).items() if _acts_in_angle(s.design, mine) and _is_stiff(_without(s, mine))
    ]


def of_a_spring_unseen(s: Solution) -> list[str]:
    """Effects in the wind-up where nobody read the motor's angle, and with it no wind-up, and the torques say nothing
    of the spring either."""
    d = s.design
    if not d.terms or any("theta_m" in run.has for run in d.eq.runs) or _is_stiff(s):
        return []
    return list(dict.fromkeys(term.name for term in d.terms if Port.WIND_UP in acting(d.eq.runs[0], term)[0]))


def instead_of_an_inertia(s: Solution) -> list[str]:
    """Effects beside which an inertia is surely below zero, as in no gear, and without them is not: what the inertia
    was is in them. Where neither the load's angle nor its torque was read an inertia shows little, and a lever that
    goes with the load may be it."""
    if not s.design.terms or not (below := below_zero(s)):
        return []
    return [name for name, mine in _by_name(s).items() if not below <= below_zero(_without(s, mine))]


def hidden_by_the_gear(s: Solution) -> list[str]:
    """An eccentric motor encoder beside which the kinematic error is larger once a turn than twice, and without it is
    not. A wave generator has two lobes, and so its error: of 15 true ones in exams 97 to 105 the first order was at
    most 0.22 of the second. What would be in the angle and is not there is a torque once a turn that grows with the
    square of the speed, as an acceleration does (exam 105, case 08)."""
    mine = _by_name(s).get(MotorEncoderEccentricity.name, [])
    return [MotorEncoderEccentricity.name] if mine and _once(s) > 1.0 >= _once(_without(s, mine)) else []


def _once(s: Solution) -> float:
    """First order of the kinematic error over its second; 0 where no angle told one."""
    if s.gram[INDEX["a1"], INDEX["a1"]] <= UNSEEN:
        return 0.0
    first, second = (float(np.hypot(s.value(f"a{n}"), s.value(f"b{n}"))) for n in (1, 2))
    return first / max(second, 1e-300)


def at_a_vibration(own: Own, words: Mapping[str, Sequence[Parameter]]) -> list[str]:
    """Effects that resonate where the rig is shaken, so that a vibration that is not quite the one of the model, in
    its phase or with its speed, is a resonance to them."""
    lines = [p.value for p in own.parameters.get(VIBRATION.name, ()) if p.name.startswith(FREQUENCY)]
    tones = {name: [p.value for p in found if p.name.startswith(FREQUENCY)] for name, found in words.items()}
    return [name for name, found in tones.items() if any(abs(f / line - 1) < SAME for f in found for line in lines)]


def below_zero(s: Solution, of: Sequence[str] = INERTIAS) -> frozenset[str]:
    """Those of the gear's numbers that are surely below zero."""
    known = covariance(s)
    return frozenset(
        name for name in of if s.value(name) < -Z95 * float(np.sqrt(max(0.0, known[INDEX[name], INDEX[name]])))
    )


def _by_name(s: Solution) -> dict[str, list[int]]:
    """The places of each effect's terms."""
    terms = s.design.terms
    return {one.name: [i for i, term in enumerate(terms) if term.name == one.name] for one in terms}


def _without(s: Solution, places: Sequence[int]) -> Solution:
    return fit(reduced(s.design, places))


def _is_stiff(s: Solution) -> bool:
    """Whether the compliance is known to a third of itself."""
    at = INDEX["compliance"]
    return KNOWN * s.value("compliance") > Z95 * float(np.sqrt(max(0.0, covariance(s)[at, at])))


def _acts_in_angle(d: Design, places: Sequence[int]) -> bool:
    starts = {int(d.place(i).start) for i in places}
    return any(int(part.at[0]) in starts for key, parts in d.parts.items() if key[1] == "A" for part in parts)
