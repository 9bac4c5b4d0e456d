"""One [channels.NAME] table of a mapping file: where a channel comes from and what turns it into SI."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

from rig.core.channels import CHANNEL
from rig.core.errors import UsageError
from rig.runfile.importing.strict import Section, nearest
from rig.runfile.importing.units import known, unit_of

NEEDED = ("t", "theta_m", "theta_l")  # a hole in one of these cannot be kept as null: the rows would lose their order
QUANTITY = {
    "t": "time", "theta_m": "angle", "theta_l": "angle", "theta_ref": "angle", "omega_m": "speed", "tau_m": "torque",
    "tau_l": "torque", "tau_ask": "torque", "tau_applied": "torque", "counts_m": "counts", "counts_l": "counts",
}  # fmt: skip
OURS = tuple(name for name in CHANNEL if name not in QUANTITY)  # written by our recorder, meaningless from elsewhere


@dataclass(frozen=True)
class Term:
    """One column and what it is multiplied with."""

    column: str
    scale: float = 1.0


@dataclass(frozen=True)
class ChannelMap:
    """value = sign·(Σ scale·(column − zero)) + offset, all in `unit`; `modulus` unwraps the column first."""

    name: str
    terms: tuple[Term, ...]
    quantity: str  # "" for an extra channel in a unit of its own
    unit: str = ""  # "" = the file must state it
    meaning: str = ""
    sign: int = 1
    zero: float = 0.0
    offset: float = 0.0
    counts_per_turn: int = 0
    modulus: float = 0.0  # in `unit`; 0 = unwrapped already
    drop_duplicates: bool = False
    drop_holes: bool = False  # rows without a value here are left out; else they are refused

    @property
    def plain(self) -> bool:
        """True when the column's own numbers are in `unit`: nothing is summed or scaled."""
        return len(self.terms) == 1 and self.terms[0].scale == 1.0


def read_channel(name: str, raw: Section) -> ChannelMap:
    """The channel of this name. Raises UsageError naming file and key."""
    quantity = QUANTITY.get(name, "")
    if not quantity:
        _check_extra(name, raw)
    unit = raw.text("unit", "counts" if quantity == "counts" else "")
    terms = _terms(raw)
    keys: dict[str, Any] = {"meaning": raw.text("meaning", "")}
    if unit:
        quantity, unit = _unit(raw, name, quantity, unit)
    if name == "t":
        keys["drop_duplicates"] = raw.text("duplicates", "refuse", choices=("refuse", "drop")) == "drop"
    elif quantity != "counts" or name not in QUANTITY:
        keys |= {"sign": raw.sign("sign"), "zero": raw.number("zero", 0.0), "offset": raw.number("offset", 0.0)}
    if name in NEEDED:
        keys["drop_holes"] = raw.text("holes", "refuse", choices=("refuse", "drop")) == "drop"
    if quantity in ("angle", "counts"):
        keys |= _wheel(raw, unit, counting=quantity == "counts")
    raw.done()
    if len(terms) > 1 and (keys.get("modulus") or keys.get("zero")):
        raise UsageError(f"{raw.file}: {raw.path} is a sum; modulus, bits and zero belong to a channel of one column")
    return ChannelMap(name=name, terms=terms, quantity=quantity, unit=unit, **keys)


def _check_extra(name: str, raw: Section) -> None:
    """A channel that is not ours to interpret must say what it is."""
    if name in OURS:
        raise UsageError(f"{raw.file}: {raw.path} cannot be imported: '{name}' is what our own recorder says of a row")
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        raise UsageError(f"{raw.file}: {raw.path} is no name for a channel; expected letters, digits and _")
    for key in ("unit", "meaning"):
        if not raw.has(key):
            raise UsageError(
                f"{raw.file}: {raw.missing(key)}; '{name}' is no standard channel ({nearest(name, QUANTITY)}), "
                "and any other needs unit and meaning"
            )


def _unit(raw: Section, name: str, quantity: str, text: str) -> tuple[str, str]:
    """(quantity, unit word). An extra channel keeps a unit we do not know as it is written."""
    if quantity == "counts":
        if (found := known(text)) is None or found.word != "counts":
            raw.refuse("unit", text, "'counts': this channel is raw")
        return quantity, "counts"
    if name in QUANTITY:
        return quantity, unit_of(text, quantity, f"{raw.file}: {raw.path}").word
    found = known(text)
    if found is None:
        return "", text
    if found.word == "datetime":
        raw.refuse("unit", text, "a number's unit; only t may be a date")
    return ("counts" if found.word == "counts" else found.quantity), found.word


def _terms(raw: Section) -> tuple[Term, ...]:
    """`column` with its scale, or the terms of `sum`; exactly one of the two."""
    if raw.has("column") and raw.has("sum"):
        raise UsageError(f"{raw.file}: {raw.path} has column and sum; expected one of them")
    if raw.has("column"):
        return (_term(raw),)
    if not raw.has("sum"):
        raise UsageError(f"{raw.file}: {raw.missing('column')} (or sum = [{{column = …, scale = …}}, …])")
    inner = raw.tables("sum")
    if not inner or raw.path == "channels.t" or raw.path.startswith("channels.counts_"):
        raise UsageError(f"{raw.file}: {raw.path}.sum: expected " + ("at least one term" if not inner else "a column"))
    terms = tuple(_term(term) for term in inner)
    for term in inner:
        term.done()
    return terms


def _term(raw: Section) -> Term:
    term = Term(raw.text("column"), raw.number("scale", 1.0))
    if term.scale == 0:
        raw.refuse("scale", term.scale, "a number other than 0")
    return term


def _wheel(raw: Section, unit: str, counting: bool) -> dict[str, Any]:
    """What a full turn and a full counter are: counts_per_turn, and modulus or bits."""
    keys: dict[str, Any] = {"counts_per_turn": 0} if counting else {"counts_per_turn": _per_turn(raw, unit)}
    if raw.has("modulus") and raw.has("bits"):
        raise UsageError(f"{raw.file}: {raw.path} has modulus and bits; expected one of them")
    modulus = raw.number("modulus", 0.0, above=0) if raw.has("modulus") else 0.0
    bits = raw.whole("bits", 0, least=1, most=62) if raw.has("bits") else 0
    if unit == "counts" and modulus != int(modulus):
        raw.refuse("modulus", modulus, "a whole number of counts")
    if bits and unit not in ("counts", ""):
        raw.refuse("bits", bits, f"modulus in {unit}; bits is for unit = 'counts'")
    return {**keys, "modulus": float(2**bits) if bits else modulus}


def _per_turn(raw: Section, unit: str) -> int:
    if unit == "counts":
        return raw.whole("counts_per_turn", least=1)
    if unit and raw.has("counts_per_turn"):
        raw.refuse("counts_per_turn", raw.whole("counts_per_turn"), f"none with unit = '{unit}'")
    return raw.whole("counts_per_turn", 0, least=1) if raw.has("counts_per_turn") else 0
