"""Values taken from the tables of a gear file, each as what it has to be. Raises DataError: where, value, expected."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

from rig.core.errors import DataError
from rig.core.nearest import nearest
from rig.core.numbers import number
from rig.model.gearfile.content import ORIGINS


def only_keys(where: str, raw: Mapping[str, Any], valid: Iterable[str]) -> None:
    """Unknown keys are refused, with the nearest valid one."""
    known = sorted(valid)
    for key in raw:
        if key not in known:
            raise DataError(f"unknown key '{key}' in {where}; {nearest(key, known)}")


def table_at(raw: Mapping[str, Any], key: str) -> dict[str, Any]:
    """The table at `key`."""
    if not isinstance(raw.get(key), dict):
        raise DataError(f"[{key}] is missing or no table")
    return dict(raw[key])


def number_at(raw: Mapping[str, Any], key: str, where: str) -> float:
    """The finite number at `key`."""
    found = number(raw.get(key))
    if math.isnan(found):
        raise DataError(f"{where}.{key} = {raw.get(key)!r}: expected a finite number")
    return found


def numbers_at(raw: Mapping[str, Any], key: str, where: str) -> list[float]:
    """The list of finite numbers at `key`, in rad."""
    values = raw.get(key)
    if not isinstance(values, list):
        raise DataError(f"{where}.{key} = {values!r}: expected a list of numbers in rad")
    return [number_at({key: v}, key, where) for v in values]


def origin_of(raw: Mapping[str, Any], where: str) -> str:
    """Where a number comes from, one of ORIGINS."""
    origin = raw.get("from")
    if origin not in ORIGINS:
        raise DataError(f"{where}.from = {origin!r}: expected one of {', '.join(ORIGINS)}")
    return str(origin)


def text_at(raw: Mapping[str, Any], key: str, where: str) -> str:
    """The text at `key`, "" where there is none."""
    value = raw.get(key, "")
    if not isinstance(value, str):
        raise DataError(f"{where}{'.' if where else ''}{key} = {value!r}: expected text")
    return value


def texts_at(raw: Mapping[str, Any], key: str, where: str) -> tuple[str, ...]:
    """The list of texts at `key`, none where it is absent."""
    values = raw.get(key, [])
    if not isinstance(values, list) or not all(isinstance(v, str) for v in values):
        raise DataError(f"{where}{'.' if where else ''}{key} = {values!r}: expected a list of texts")
    return tuple(values)
