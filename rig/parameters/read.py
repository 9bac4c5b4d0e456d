"""A procedure's parameters as somebody wrote them, on a command line or in a plan, checked against its fields."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import MISSING, Field, fields
from typing import Any, Final, TypeVar

from rig.core.errors import UsageError
from rig.core.nearest import nearest
from rig.parameters.told import told

Made = TypeVar("Made")
LARGEST = 1e12  # in any unit: nothing on a rig is near
WORDS = {
    float: "a finite number",
    int: "a whole number",
    str: "text",
    bool: "true or false",
    tuple: "a list of numbers",
}


NUMBER: Final = re.compile(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")
DECIMAL_COMMA: Final = re.compile(r"[-+]?\d+,\d+")
THOUSANDS: Final = re.compile(r"[-+]?[1-9]\d{0,2},\d{3}")
ANOTHER: Final = re.compile(r",\s*(\w+)\s*=")
WITH_MORE: Final = re.compile(r"[-+]?\d+(?:\.\d*)?(?:[eE][-+]?\d+)?\s*([^\d\s.,+-].*)")


class _RefusedError(Exception):
    """A value and what was expected of it, without who asks."""

    def __init__(self, raw: Any, expected: str) -> None:
        self.raw, self.expected = raw, expected
        super().__init__(expected)


def make(kind: type[Made], given: Mapping[str, Any], title: str) -> Made:
    """`kind`, a dataclass whose fields all have defaults, with the values `given`; `title` is what errors call it.

    A field takes numbers above 0 only, unless its metadata say `signed`. Raises UsageError: unknown name, wrong type,
    a value that makes no sense.
    """
    known = {f.name: f for f in fields(kind)}  # type: ignore[arg-type]
    for name in given:
        if name not in known:
            raise UsageError(f"{title} has no parameter '{name}'; {nearest(name, known)}")
    for name, raw in given.items():
        _refuse_several(name, raw, known)
        _refuse_unit(kind, known[name], raw)
    values = {}
    for name, raw in given.items():
        try:
            values[name] = _value(known[name], raw)
        except _RefusedError as refused:
            raise UsageError(_sentence(kind, name, refused)) from None
    try:
        return kind(**values)
    except (OverflowError, ZeroDivisionError):
        shown = ", ".join(f"{name} = {raw}" for name, raw in given.items())
        raise UsageError(f"{title}: the parameters {shown} cannot be meant") from None


def _refuse_several(name: str, raw: Any, known: Mapping[str, Any]) -> None:
    """Raises UsageError where another parameter stands behind a comma: a list has no names in it."""
    if isinstance(raw, str) and (found := ANOTHER.search(raw)) and found[1] in known:
        first, more = raw[: found.start()].strip(), raw[found.start() + 1 :].strip()
        raise UsageError(
            f"{name} = {raw[:60]}: expected one parameter at a time, {name}={first[:30]} and then {more[:30]} by itself"
        )


def _refuse_unit(kind: type[Any], field: Field[Any], raw: Any) -> None:
    """Raises UsageError for a number with something behind it, or with a decimal comma, where a number is wanted."""
    if not isinstance(raw, str) or not isinstance(field.default, float | int) or isinstance(field.default, bool):
        return
    if DECIMAL_COMMA.fullmatch(raw.strip()):
        point, none = (raw.strip().replace(",", instead) for instead in (".", ""))
        meant = f", or no comma between thousands, {none}" if THOUSANDS.fullmatch(raw.strip()) else ""
        raise UsageError(f"{field.name} = {raw.strip()[:60]}: expected a decimal point, {point}{meant}")
    if (found := WITH_MORE.fullmatch(raw.strip())) is None:
        return
    unit = next(one.unit for one in told(kind) if one.name == field.name)
    wanted = f"a number in {unit}, without the unit" if unit else f"a number alone, without '{found[1][:20]}'"
    raise UsageError(f"{field.name} = {raw.strip()[:60]}: expected {wanted}, for example {field.default}")


def _value(field: Field[Any], raw: Any) -> Any:
    """`raw` as the field wants it. Raises UsageError."""
    wanted = type(field.default) if field.default is not MISSING else str
    signed = bool(field.metadata.get("signed", False))
    if wanted is tuple and isinstance(raw, str):
        raw = _listed(raw)
    one = isinstance(raw, float | int) and not isinstance(raw, bool)
    if wanted is tuple and one:
        return (_number(raw, signed),)
    if wanted is tuple and isinstance(raw, list | tuple) and raw:
        return tuple(_number(value, signed) for value in raw)
    if wanted is float:
        return _number(raw, signed)
    if wanted is str and isinstance(raw, list | tuple):  # and a list of several
        return ",".join(f"{_number(value, signed=True):.12g}" for value in raw)
    if wanted is str and one:  # a list written as text, of one: 900 for "900"
        return f"{_number(raw, signed=True):.12g}"
    if not isinstance(raw, wanted) or isinstance(raw, bool) is not (wanted is bool):
        raise _RefusedError(raw, _spelt(raw) if wanted is int else WORDS.get(wanted, wanted.__name__))
    if isinstance(raw, int) and not isinstance(raw, bool):
        _number(raw, signed)
    return raw


def _spelt(raw: Any) -> str:
    """What is expected where a whole number is wanted: of 1e6 and 2.0, which are whole, that they are spelt so."""
    if isinstance(raw, float) and raw.is_integer() and abs(raw) < LARGEST:
        return f"{WORDS[int]} in digits alone, {raw:.0f}"
    return WORDS[int]


def _listed(text: str) -> Any:
    """ "(1.0, 0.3)", "[1.0, 0.3]", "(1.0,)" and "1.0,0.3" as numbers; anything else, with an empty item, as it is."""
    words = text.strip().strip("()[]").split(",")
    if len(words) > 1 and not words[-1].strip():
        words.pop()
    try:
        return [float(word) for word in words]
    except ValueError:
        return text


def _number(raw: Any, signed: bool) -> float:
    if isinstance(raw, bool) or not isinstance(raw, float | int) or not -math.inf < raw < math.inf:
        raise _RefusedError(raw, WORDS[float])
    if not -LARGEST < raw < LARGEST:
        raise _RefusedError(raw, f"a number below {LARGEST:g}")
    if raw <= 0 and not signed:
        raise _RefusedError(raw, "more than 0")
    return float(raw)


def _sentence(kind: type[Any], name: str, refused: _RefusedError) -> str:
    """Name, value, what was expected and its unit, and an example as --with takes it."""
    field = next(one for one in told(kind) if one.name == name)
    shown, expected = str(refused.raw), refused.expected
    shown = shown if len(shown) <= 60 else shown[:57] + "..."
    if (
        isinstance(refused.raw, str)
        and expected in (WORDS[float], WORDS[int])
        and NUMBER.fullmatch(refused.raw.strip())
    ):
        shown, expected = f'"{shown}"', f"{expected}, not text"
    unit = f" {field.unit}" if field.unit and expected[-1].isdigit() else ""
    return f"{name} = {shown}: expected {expected}{unit}, for example {field.written(field.default)}"
