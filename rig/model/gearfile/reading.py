"""A gear file read strictly: an error names file, key, value, what was expected and the nearest valid key."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from rig.core.errors import DataError, UsageError
from rig.core.regular import regular
from rig.core.toml import read_toml
from rig.model.fourier import FourierSeries
from rig.model.gear import SIGMA
from rig.model.gearfile.content import (
    CHARACTERISTICS,
    COVERED,
    SCHEMA,
    UNITS,
    Covered,
    GearFile,
    MeasuredSeries,
    Parameter,
)
from rig.model.gearfile.values import number_at, numbers_at, only_keys, origin_of, table_at, text_at, texts_at

TOP = (
    "schema",
    "serial",
    "output",
    "simulated",
    "made",
    "cannot",
    "covered",
    "parameters",
    "characteristics",
    "kinematic_error",
)
KEYS = ("value", "low", "high", "unit", "from", "runs", "note")
SERIES_KEYS = ("a", "b", "covariance", "unit", "from", "runs", "note")


def read(path: Path) -> GearFile:
    """The gear file at `path`. Raises UsageError: no such file, no TOML, a key or value that is wrong."""
    try:
        regular(path)
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise UsageError(f"{path} is not UTF-8 text; expected a gear file in TOML") from None
    except OSError as error:
        raise UsageError(f"cannot read {path}: {error.strerror}") from None
    return loads(text, str(path))


def loads(text: str, source: str) -> GearFile:
    """The gear in `text`; `source` is what errors call it. Raises UsageError, one sentence."""
    raw = read_toml(text, source)
    try:
        return _gear(raw)
    except DataError as error:
        raise UsageError(f"{source}: {error}") from None


def _gear(raw: dict[str, Any]) -> GearFile:
    if raw.get("schema") != SCHEMA:
        raise DataError(f"schema = {raw.get('schema')!r}: expected '{SCHEMA}', so this is no gear file")
    only_keys("the file", raw, TOP)
    numbers = table_at(raw, "parameters")
    only_keys("parameters", numbers, UNITS)
    missing = [name for name in UNITS if name not in numbers]
    if missing:
        raise DataError(f"'parameters.{missing[0]}' is missing; expected a table with a value in {UNITS[missing[0]]}")
    beside = table_at(raw, "characteristics") if "characteristics" in raw else {}
    only_keys("characteristics", beside, CHARACTERISTICS)
    output = raw.get("output")
    if output not in SIGMA:
        raise DataError(f"output = {output!r}: expected {' or '.join(SIGMA)}")
    simulated = raw.get("simulated", False)
    if not isinstance(simulated, bool):
        raise DataError(f"simulated = {simulated!r}: expected true or false")
    return GearFile(
        parameters={name: _read_parameter(f"parameters.{name}", name, numbers[name], UNITS[name]) for name in UNITS},
        characteristics={
            name: _read_parameter(f"characteristics.{name}", name, value, CHARACTERISTICS[name])
            for name, value in beside.items()
        },
        kinematic_error=_read_series(table_at(raw, "kinematic_error")),
        output=output,
        serial=text_at(raw, "serial", ""),
        simulated=simulated,
        made=text_at(raw, "made", ""),
        cannot=texts_at(raw, "cannot", ""),
        covered=_read_covered(table_at(raw, "covered")) if "covered" in raw else None,
    )


def _read_covered(raw: Mapping[str, Any]) -> Covered:
    only_keys("covered", raw, COVERED)
    ends = {}
    for name, unit in COVERED.items():
        value = raw.get(name)
        numbers = [number_at({name: v}, name, "covered") for v in value] if isinstance(value, list) else []
        if len(numbers) != 2 or numbers[0] > numbers[1]:
            raise DataError(f"covered.{name} = {value!r}: expected the least and the largest, {unit}")
        ends[name] = (numbers[0], numbers[1])
    return Covered(**ends)


def _read_parameter(where: str, name: str, raw: Any, unit: str) -> Parameter:
    if not isinstance(raw, dict):
        raise DataError(f'{where} = {raw!r}: expected {{ value = …, unit = "{unit}", from = … }}')
    only_keys(where, raw, KEYS)
    if raw.get("unit") != unit:
        raise DataError(f"{where}.unit = {raw.get('unit')!r}: expected '{unit}'; units are never converted")
    value = number_at(raw, "value", where)
    if value <= 0.0 if name in ("N", "J_m", "J_l", "K", "omega_s") else name.startswith("tau") and value < 0.0:
        raise DataError(f"{where}.value = {value:g}{'' if unit == '1' else f' {unit}'}: expected more than 0")
    interval = (math.nan, math.nan)
    if "low" in raw or "high" in raw:
        interval = (number_at(raw, "low", where), number_at(raw, "high", where))
        if not interval[0] <= value <= interval[1]:
            raise DataError(f"{where}: {value:g} lies outside its own interval {interval[0]:g} to {interval[1]:g}")
    return Parameter(value, interval, origin_of(raw, where), texts_at(raw, "runs", where), text_at(raw, "note", where))


def _read_series(raw: dict[str, Any]) -> MeasuredSeries:
    where = "kinematic_error"
    only_keys(where, raw, SERIES_KEYS)
    if raw.get("unit") != "rad":
        raise DataError(f"{where}.unit = {raw.get('unit')!r}: expected 'rad' at the output")
    a, b = numbers_at(raw, "a", where), numbers_at(raw, "b", where)
    if len(a) != len(b):
        raise DataError(f"{where}: {len(a)} cosine and {len(b)} sine coefficients, expected as many of each")
    size = 2 * len(a)
    covariance = np.full((size, size), math.nan)
    if "covariance" in raw:
        try:
            covariance = np.array(raw["covariance"], dtype=np.float64).reshape(size, size)
        except (TypeError, ValueError):
            raise DataError(f"{where}.covariance: expected {size} rows of {size} numbers in rad²") from None
    found = FourierSeries(tuple(a), tuple(b))
    return MeasuredSeries(
        found, covariance, origin_of(raw, where), texts_at(raw, "runs", where), text_at(raw, "note", where)
    )
