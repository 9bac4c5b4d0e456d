"""--limit NAME=VALUE: what a run's figures are judged against; PASS, FAIL or INCONCLUSIVE instead of "no limit set"."""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from typing import Any

from rig.core.errors import UsageError

FORM = (
    "expected NAME=UPPER, NAME=LOWER.. or NAME=LOWER..UPPER, in the figure's unit or with a space and another, for "
    "example 'peak-to-peak=60 arcsec' or 'K1=7000..'"
)


def limit_argument(parser: argparse.ArgumentParser) -> None:
    """--limit, as often as there are limits."""
    parser.add_argument(
        "--limit",
        action="append",
        default=[],
        dest="limits",
        metavar="NAME=LIMIT",
        help="judge a figure: at most 'peak-to-peak=60 arcsec', at least 'K1=7000..', between 'C_2=30..40'; "
        "names as in hdrig trend or result.json; without a unit in the figure's, an angle also in arcsec, arcmin, deg, "
        "rad or mrad",
    )


def limits_of(assignments: Sequence[str]) -> dict[str, Any]:
    """What --limit says, as a manifest's `limits` has it. Raises UsageError."""
    from rig.catalogue.figures import names_of

    limits: dict[str, Any] = {}
    for assignment in assignments:
        word, equals, text = (part.strip() for part in assignment.partition("="))
        if not (word and equals):
            raise UsageError(f"--limit {assignment}: {FORM}")
        for name in names_of(word)[:1]:
            limits[name] = _bounds(assignment, text)
    return limits


def _bounds(assignment: str, text: str) -> dict[str, Any]:
    numbers, _, unit = text.partition(" ")
    low, both, high = numbers.partition("..")
    said = {"lower": low, "upper": high} if both else {"upper": numbers}
    bounds: dict[str, Any] = {key: _number(assignment, number) for key, number in said.items() if number}
    if not bounds or list(bounds.values()) != sorted(bounds.values()):
        raise UsageError(f"--limit {assignment}: {FORM}")
    return bounds | ({"unit": unit.strip()} if unit else {})


def _number(assignment: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise UsageError(f"--limit {assignment}: '{text}' is not a number; {FORM}")
    return value
