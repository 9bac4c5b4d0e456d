"""Is what was measured a gear at all? Signs and units that are wrong show in numbers that no gear has."""

from __future__ import annotations

from collections.abc import Mapping

from rig.analysis.motion.declared import declared
from rig.core.errors import DataError
from rig.model.gearfile import UNITS, Parameter

SIGNS = {
    "J_l": "tau_l seems to have the other sign than equation 7 gives it",
    "F_cl": "tau_l seems to have the other sign than equation 7 gives it",
    "tau_c": "tau_m seems to have the other sign than equation 6 gives it, or tau_l another unit than N·m",
    "J_m": "tau_m or tau_l seems to have the other sign than equation 6 gives it, or another unit than N·m",
}
"""What makes a number negative that is never so."""

DRAGS = ("B_sp", "B_m", "B_l")
ABOVE_ZERO = ("J_m", "J_l", "K", "omega_s")  # what no gear is without
BOUNDED = (*ABOVE_ZERO, "tau_c", "tau_s", "F_cl", "B_m", "B_ml", "B_l", "B_sp")
FAR = 10.0  # times what is declared, or a part of it: no estimate of a builder is as far off
SURELY = 5.0  # halves of its 95 % interval: a wrong sign makes it as large below zero, and chance a little
COMPARED = ("K", "J_l", "J_m")


def refuse_impossible(found: Mapping[str, Parameter]) -> None:
    """Raises DataError for an inertia or a Coulomb friction that is measured to be far below zero."""
    for name, why in SIGNS.items():
        p = found.get(name)
        if p is not None and _negative(p) and p.value < -SURELY * p.half:
            raise DataError(f"{name} comes out at {_said(name, p)}, expected above 0: {why}")


def taken_out(found: dict[str, Parameter]) -> list[str]:
    """Takes out of `found` every number that no gear has, however uncertain: it is not known. A sentence for each."""
    said = []
    for name in [name for name in BOUNDED if name in found and not _possible(name, found[name].value)]:
        least = "above 0" if name in ABOVE_ZERO else "0 or more"
        said.append(f"{name} cannot be told: it comes out at {_said(name, found.pop(name))}, expected {least}.")
    return said


def _possible(name: str, value: float) -> bool:
    return value > 0.0 if name in ABOVE_ZERO else value >= 0.0


def strange(found: Mapping[str, Parameter], said: Mapping[str, object]) -> list[str]:
    """A sentence for every damping measured to be negative, and every number far from what is declared."""
    out = [
        f"{name} comes out at {_said(name, found[name])}: no part of a gear gives energy; something in these runs is "
        "not in the model, a delay between channels for one."
        for name in DRAGS
        if name in found and _negative(found[name])
    ]
    for name in COMPARED:
        expected = declared(said, name)
        if expected is None or name not in found or found[name].origin != "measured":
            continue
        if not expected / FAR < found[name].value < expected * FAR:
            out.append(
                f"{name} comes out at {_said(name, found[name])}, declared {expected:g} {UNITS[name]}: an angle or a "
                "torque in another unit than rad and N·m, or another gear?"
            )
    return out


def _negative(p: Parameter) -> bool:
    return p.origin == "measured" and p.interval[1] < 0.0


def _said(name: str, p: Parameter) -> str:
    return f"{p.value:.3g} ± {p.half:.2g} {UNITS[name]}"
