"""Exhibits as text: claims with their numbers filled in, for the page, the terminal and reproduction.json."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

from rig.analysis.reproduction.claim import Claim, Number, Ruling
from rig.analysis.reproduction.exhibit import Cell, Exhibit
from rig.report.numbers import counted, estimate, plain

SIGN = {Ruling.HOLDS: "✓", Ruling.FAILS: "✗", Ruling.OPEN: "–"}
TONE = {Ruling.HOLDS: "good", Ruling.FAILS: "bad", Ruling.OPEN: "plain"}
SAID = {Ruling.HOLDS: "The data say so too:", Ruling.FAILS: "The data say otherwise:", Ruling.OPEN: "Cannot be told:"}


def number(n: Number) -> str:
    """With interval and unit."""
    return estimate(n.value, (n.low, n.high), n.unit)


def found(claim: Claim) -> str:
    """What the data say."""
    return claim.words.format(*(number(n) for n in claim.numbers))


def cell(value: Cell) -> str:
    """One cell of a table."""
    match value:
        case Number():
            return number(value)
        case str():
            return value
        case _:
            return plain(value, 5)


def count(exhibits: Sequence[Exhibit]) -> dict[Ruling, int]:
    """How many claims are ruled which way."""
    rulings = Counter(c.ruling for e in exhibits for c in e.claims)
    return {ruling: rulings[ruling] for ruling in Ruling}


def told(exhibits: Sequence[Exhibit]) -> Iterator[str]:
    """For a terminal: one line a claim."""
    for e in exhibits:
        yield f"{e.number}  {e.title}"
        for c in e.claims:
            yield f"  {SIGN[c.ruling]} {c.paper}: {found(c)}"
    rulings = count(exhibits)
    yield (
        f"of {counted(sum(rulings.values()), 'claim')} of the paper {rulings[Ruling.HOLDS]} hold by these runs, "
        f"{rulings[Ruling.FAILS]} fail, {rulings[Ruling.OPEN]} cannot be told"
    )


def record(exhibits: Sequence[Exhibit]) -> list[dict[str, Any]]:
    """For reproduction.json; numbers that could not be had are null."""
    return [
        {
            "number": e.number, "title": e.title, "how": e.how, "missing": e.missing,
            "claims": [
                {
                    "paper": c.paper, "ruling": c.ruling.value, "found": found(c), "rule": c.rule,
                    "numbers": [_number(n) for n in c.numbers],
                }
                for c in e.claims
            ],
        }
        for e in exhibits
    ]  # fmt: skip


def _number(n: Number) -> dict[str, Any]:
    ends = {"value": n.value, "low": n.low, "high": n.high}
    return {key: x if math.isfinite(x) else None for key, x in ends.items()} | {"unit": n.unit}
