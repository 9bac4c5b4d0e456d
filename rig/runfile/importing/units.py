"""The unit words an import understands, each with its factor to SI, by quantity."""

from __future__ import annotations

import re
from typing import NamedTuple

from rig.core.errors import UsageError
from rig.core.units import TURN
from rig.runfile.importing.strict import nearest


class Unit(NamedTuple):
    """`factor` turns a number in this unit into SI; None where the mapping must say more (counts, dates)."""

    word: str
    quantity: str
    factor: float | None


SI = {"angle": "rad", "time": "s", "torque": "N·m", "speed": "rad/s"}

_TABLE: dict[str, dict[str, float | None]] = {
    "angle": {
        "rad": 1.0,
        "mrad": 1e-3,
        "deg": TURN / 360,
        "arcmin": TURN / 360 / 60,
        "arcsec": TURN / 360 / 3600,
        "turns": TURN,
        "counts": None,  # needs counts_per_turn
    },
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "datetime": None},
    "torque": {
        "N·m": 1.0,
        "mN·m": 1e-3,
        "cN·m": 1e-2,
        "kN·m": 1e3,
        "kgf·m": 9.80665,  # standard gravity, exact
        "kgf·cm": 0.0980665,
        "lbf·ft": 1.3558179483314004,  # 0.45359237 kg · 9.80665 m/s² · 0.3048 m
        "lbf·in": 0.1129848290276167,
        "ozf·in": 0.007061551814226044,
    },
    "speed": {"rad/s": 1.0, "deg/s": TURN / 360, "turns/s": TURN, "rpm": TURN / 60},
}
_SPELLINGS = {
    "°": "deg", "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad", "'": "arcmin", "″": "arcsec",
    "rev": "turns", "revs": "turns", "turn": "turns", "count": "counts", "inc": "counts", "ticks": "counts",
    "sec": "s", "second": "s", "seconds": "s", "msec": "ms", "milliseconds": "ms", "µs": "us", "usec": "us",
    "microseconds": "us", "nsec": "ns", "nanoseconds": "ns", "minutes": "min", "hours": "h",
    "Nm": "N·m", "Ncm": "cN·m", "Nmm": "mN·m", "mNm": "mN·m", "cNm": "cN·m", "kNm": "kN·m",
    "kgfm": "kgf·m", "kgfcm": "kgf·cm", "lbfft": "lbf·ft", "lbfin": "lbf·in", "ozfin": "ozf·in",
    "ftlb": "lbf·ft", "inlb": "lbf·in",
    "°/s": "deg/s", "1/min": "rpm", "min^-1": "rpm", "r/min": "rpm", "rev/s": "turns/s",
}  # fmt: skip
UNITS = {word: Unit(word, quantity, f) for quantity, words in _TABLE.items() for word, f in words.items()}


def known(text: str) -> Unit | None:
    """The unit a word means, whatever its spelling ("Nm", "N*m", "N.m", "°", "µs"); None for one not in the table."""
    word = text.strip().strip("[]()").replace("\u03bc", "µ").replace("\u22c5", "·")
    if word in UNITS:
        return UNITS[word]
    bare = word
    for mark in "·*. -":
        bare = bare.replace(mark, "")
    spelt = _SPELLINGS.get(word) or _SPELLINGS.get(bare) or _SPELLINGS.get(word.lower())
    return UNITS[spelt] if spelt else None


def in_name(column: str) -> str:
    """The unit that a column's name ends with in brackets, as in "Time [s]" or "load (deg)"; "" where it states none
    that is known."""
    found = re.fullmatch(r".*\S\s*[\[(]([^\[\]()]+)[\])]\s*", column)
    return found[1] if found and known(found[1]) else ""


def unit_of(text: str, quantity: str, where: str) -> Unit:
    """The unit `text` of this quantity. Raises UsageError naming the key `where` and the units there are."""
    found = known(text)
    if found is None or found.quantity != quantity:
        others = [u.word for u in UNITS.values() if u.quantity == quantity]
        what = f" is a unit of {found.quantity}" if found else " is not known"
        raise UsageError(f"{where}.unit = '{text}'{what}; expected a unit of {quantity}: {nearest(text, others)}")
    return found
