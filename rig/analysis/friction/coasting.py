"""The inertia a coast-down gives beside the one identified from runs under torque: two ways to one number."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from rig.analysis.findings.result import Estimate, Result
from rig.model.gearfile import Parameter


@dataclass(frozen=True)
class Coasting:
    """One coast-down against the identified gear."""

    run: str
    inertia: Estimate  # kg·m² at the motor, of the coast-down
    value: float  # kg·m², J_m + J_l/N² as identified
    half: float  # kg·m², half width of its 95 % interval

    @property
    def agrees(self) -> bool:
        """Whether both differ by no more than their 95 % half widths together."""
        low, high = self.inertia.ci95
        return abs(self.inertia.value - self.value) <= math.hypot(0.5 * (high - low), self.half)


def coastings(run: str, result: Result, parameters: Mapping[str, Parameter]) -> Iterator[Coasting]:
    """What the `result` of the coast-down `run` says; nothing where `parameters` lack an inertia."""
    if not {"J_m", "J_l"} <= parameters.keys():
        return
    N, J_m, J_l = (parameters[name] for name in ("N", "J_m", "J_l"))
    value, half = J_m.value + J_l.value / N.value**2, math.hypot(J_m.half, J_l.half / N.value**2)
    for e in result.estimates:
        if e.name == "inertia_at_motor":
            yield Coasting(run, e, value, half)
