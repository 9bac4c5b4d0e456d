"""A number from one unit into another of the same quantity: arcmin into arcsec, N·m/arcmin into N·m/rad."""

from __future__ import annotations

import math

from rig.runfile.importing.units import UNITS, known


def factor(given: str, wanted: str) -> float:
    """What a number in `given` is multiplied by to be one in `wanted`; NaN where they are not of one quantity.

    The words are those of `hdrig import`, whatever their spelling, and quotients of them.
    """
    if given == wanted:
        return 1.0
    ours, theirs = _si(given), _si(wanted)
    return ours[1] / theirs[1] if ours[0] == theirs[0] else math.nan


def others(wanted: str) -> str:
    """The units a number may be given in to be one in `wanted`: "arcsec, or rad, mrad …", or `wanted` alone."""
    unit = known(wanted)
    words = [] if unit is None else [u.word for u in UNITS.values() if u.quantity == unit.quantity and u.factor]
    return ", ".join(dict.fromkeys([wanted, *words]))


def _si(text: str) -> tuple[tuple[str, ...], float]:
    """Quantities, that of a quotient with its divisor's, and factor to SI; NaN for a word that is not known."""
    unit = known(text)
    parts = [unit] if unit else [known(part) for part in text.split("/")]
    if len(parts) > 2 or any(part is None or part.factor is None for part in parts):
        return (text,), math.nan
    over, *under = [part for part in parts if part]
    return tuple(u.quantity for u in (over, *under)), (over.factor or 1.0) / math.prod(u.factor or 1.0 for u in under)
