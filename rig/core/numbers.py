"""Numbers as files of people and of other programs hold them: anything may stand where one is expected."""

from __future__ import annotations

import math
from collections.abc import Mapping


def number(value: object, otherwise: float = math.nan) -> float:
    """`value` where it is a finite number, `otherwise` for all else: text, yes or no, infinity, one no double holds."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return otherwise
    try:
        found = float(value)
    except OverflowError:
        return otherwise
    return found if math.isfinite(found) else otherwise


def stated(value: object, otherwise: float = math.nan) -> float:
    """A declared number: bare, or in a table with its unit and origin, {"value": 9000, "unit": …}."""
    return number(value.get("value") if isinstance(value, Mapping) else value, otherwise)
