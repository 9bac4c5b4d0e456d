"""What a run's manifest declares: single numbers, and the gear as the paper's model has it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rig.analysis.motion.source import Source
from rig.core.numbers import stated
from rig.model.fourier import FourierSeries
from rig.model.gear import Gear

FAR = 30.0  # times the declared value, or a part of it: no gear misses its design value by that
SI = {"K": "N·m/rad", "J_m": "kg·m²", "J_l": "kg·m²"}


def declared(values: Mapping[str, Any], key: str) -> float | None:
    """A declared number, bare or as {"value": …}; None when absent or not a positive number."""
    found = stated(values.get(key))
    return found if found > 0.0 else None


def declared_gear(run: Source) -> Gear | None:
    """What the manifest declares, dampings 0 where it says none; None without J_m, J_l and K."""
    J_m, J_l, K = (declared(run.declared, key) for key in ("J_m", "J_l", "K"))
    if J_m is None or J_l is None or K is None:
        return None
    B_m, B_l, B_ml, B_sp = (declared(run.declared, key) or 0.0 for key in ("B_m", "B_l", "B_ml", "B_sp"))
    return Gear(run.ratio, J_m, J_l, K, B_m, B_l, B_ml, B_sp, FourierSeries((), ()))


def beside(name: str, found: float, said: float) -> str:
    """ "7.16e+06 N·m/rad, 1e+03 times the 7.16e+03 declared", of K, J_m or J_l."""
    return f"{found:.3g} {SI[name]}, {found / said:.3g} times the {said:.3g} declared"


def far_off(name: str, found: float, said: float) -> str:
    """Says that `found` and what is declared cannot be of one rig in one unit; "" where they can."""
    if 1 / FAR < found / said < FAR:
        return ""
    return (
        f"{name} comes out as {beside(name, found, said)}: one of them is in another unit, or was declared of another "
        "rig."
    )
