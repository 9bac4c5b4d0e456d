"""What the manifest of a run says of the gear and of the run, as far as it is a number."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from rig.analysis.motion.source import Source
from rig.analysis.motion.tame import LARGEST
from rig.core import numbers
from rig.model.effect import Known
from rig.model.fourier import FourierSeries

LOCK_TEST = "stiffness_lock"
UNKNOWN = Known(K=7160.0, B_sp=0.0, J_m=1e-3, J_l=0.5, kinematic_error=FourierSeries((), ()))


def is_locked(run: Source) -> bool:
    """Whether the output is held."""
    return bool(run.conditions.get("output_locked")) or run.procedure == LOCK_TEST


def locked_all_the_same(run: Source) -> tuple[str, ...]:
    """A sentence on a lock test whose output is said to be free."""
    if run.procedure != LOCK_TEST or run.conditions.get("output_locked") is not False:
        return ()
    return ("it says its output is not locked, and it is a stiffness lock test: its output is taken for locked",)


def believed(run: Source) -> Known:
    """The gear as declared, to begin with; a paper-sized one where nothing is."""
    said = {name: abs(stated(run.declared, name, getattr(UNKNOWN, name))) for name in ("K", "J_m", "J_l")}
    return replace(UNKNOWN, K=said["K"], J_m=said["J_m"], J_l=said["J_l"])


def states(table: Mapping[str, Any], name: str) -> bool:
    """Whether a manifest states a number, zero among them."""
    return math.isfinite(numbers.stated(table.get(name)))


def stated(table: Mapping[str, Any], name: str, default: float) -> float:
    """The number a manifest states, bare or with its unit beside it; `default` where it is absent, zero or none."""
    value = numbers.stated(table.get(name))
    return value if 0 < abs(value) < LARGEST else default
