"""What the fault verbs are told: numbers and names."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from rig.core.errors import UsageError

Number = int | str | None
T = TypeVar("T")


def number(value: int | str) -> int:
    """An identifier or index as JSON can say it: 385 or "0x181". Raises UsageError."""
    try:
        return int(value, 0) if isinstance(value, str) else int(value)
    except ValueError:
        raise UsageError(f"'{value}' is no number; expected for example 385 or '0x181'") from None


def named(things: Mapping[str, T], name: str, what: str) -> T:
    """The thing of that name. Raises UsageError."""
    if name not in things:
        raise UsageError(f"no {what} '{name}'; expected one of {', '.join(things) or 'none: there is none'}")
    return things[name]
