"""The gear file: an identified gear on disk. Every number has its unit, its 95 % interval, its origin and its runs.

TOML, read strictly: an error names file, key, value, what was expected and the nearest valid key. What is written is
read back as the same value, bit by bit.
"""

from __future__ import annotations

import difflib
import math
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from rig.core.errors import DataError, UsageError
from rig.core.numbers import number
from rig.core.regular import regular
from rig.model.fourier import FourierSeries
from rig.model.gear import SIGMA, USUAL, Gear, sigma_of

SCHEMA = "hdrig.gear/1"
ORIGINS = ("measured", "declared", "assumed")
UNITS = {
    "N": "1",
    "J_m": "kg·m²",
    "J_l": "kg·m²",
    "K": "N·m/rad",
    "B_m": "N·m·s/rad",
    "B_ml": "N·m·s/rad",
    "B_l": "N·m·s/rad",
    "B_sp": "N·m·s/rad",
    "tau_c": "N·m",
    "tau_s": "N·m",
    "omega_s": "rad/s",
    "F_cl": "N·m",
}
"""The parameters of equations 5-7 and of the rig's friction, and the only unit each may have."""

CHARACTERISTICS = {
    "tau_break": "N·m",  # at the motor, from rest
    "lost_motion": "rad",  # at the output
    "hysteresis_loss": "rad",  # at the output, gap at zero torque
    "hysteresis_energy": "J",  # per cycle
    "K1": "N·m/rad",
    "K2": "N·m/rad",
    "K3": "N·m/rad",
    "T1": "N·m",
    "T2": "N·m",
}
"""What a gear may have beside them, where it was measured: the simulation does without."""

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


@dataclass(frozen=True)
class Parameter:
    """One number: `value`, the ends of its 95 % interval (NaN where none was measured), where it comes from."""

    value: float
    interval: tuple[float, float] = (math.nan, math.nan)
    origin: str = "measured"
    runs: tuple[str, ...] = ()
    note: str = ""

    @property
    def half(self) -> float:
        """Half the width of the interval; NaN where there is none."""
        return 0.5 * (self.interval[1] - self.interval[0])


@dataclass(frozen=True)
class MeasuredSeries:
    """θ̃_p of Equation 8 with the covariance of (a_1..a_k, b_1..b_k), rad², (2k, 2k)."""

    series: FourierSeries
    covariance: npt.NDArray[np.float64]
    origin: str = "measured"
    runs: tuple[str, ...] = ()
    note: str = ""


COVERED = {"speed_rpm": "rpm of the motor", "load": "N·m on the output"}


@dataclass(frozen=True)
class Covered:
    """Least and largest of the runs a gear was identified from: |speed| of the motor, rpm, and external torque on the
    output, N·m. Beyond it the file's numbers are a guess."""

    speed_rpm: tuple[float, float]
    load: tuple[float, float]


@dataclass(frozen=True)
class GearFile:
    """An identified gear. `cannot`: what the runs could not tell apart, one sentence each."""

    parameters: Mapping[str, Parameter]
    kinematic_error: MeasuredSeries
    output: str = USUAL
    serial: str = ""
    simulated: bool = False
    made: str = ""  # when and with what, for people
    cannot: tuple[str, ...] = field(default=())
    characteristics: Mapping[str, Parameter] = field(
        default_factory=dict
    )  # those of CHARACTERISTICS that were measured
    covered: Covered | None = None

    def gear(self) -> Gear:
        """The values alone, for simulation."""
        numbers = {name: p.value for name, p in self.parameters.items() if name != "N"}
        return Gear(
            ratio=self.parameters["N"].value,
            kinematic_error=self.kinematic_error.series,
            sigma=sigma_of(self.output),
            **numbers,
        )


def declared(gear: Gear, origin: str = "declared", serial: str = "", simulated: bool = False) -> GearFile:
    """A gear whose numbers nobody measured here, as a gear file."""
    numbers = {name: Parameter(gear.ratio if name == "N" else getattr(gear, name), origin=origin) for name in UNITS}
    size = 2 * len(gear.kinematic_error.a)
    series = MeasuredSeries(gear.kinematic_error, np.full((size, size), math.nan), origin)
    output = next(name for name, sigma in SIGMA.items() if sigma == gear.sigma)
    return GearFile(numbers, series, output, serial, simulated)


def write(path: Path, gear: GearFile) -> None:
    """Write `gear` as TOML. Raises UsageError when the file cannot be written."""
    try:
        path.write_text(dumps(gear), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"cannot write {path}: {error.strerror}; name another place with -o") from None


def dumps(gear: GearFile) -> str:
    """`gear` as TOML text."""
    import tomlkit  # only writing needs it

    document = tomlkit.document()
    head = {"schema": SCHEMA, "serial": gear.serial, "output": gear.output, "simulated": gear.simulated}
    document.update({**head, "made": gear.made, "cannot": list(gear.cannot)})
    if gear.covered is not None:
        document["covered"] = {name: list(getattr(gear.covered, name)) for name in COVERED}
    document["parameters"] = table = tomlkit.table()
    for name, unit in UNITS.items():
        inline = tomlkit.inline_table()
        inline.update(_parameter(gear.parameters[name], unit))
        table[name] = inline
    if gear.characteristics:
        document["characteristics"] = beside = tomlkit.table()
        for name, p in gear.characteristics.items():
            inline = tomlkit.inline_table()
            inline.update(_parameter(p, CHARACTERISTICS[name]))
            beside[name] = inline
    e, k = gear.kinematic_error, len(gear.kinematic_error.series.a)
    document["kinematic_error"] = series = tomlkit.table()
    series.update({"a": list(e.series.a), "b": list(e.series.b), "unit": "rad", "from": e.origin})
    series.update({"runs": list(e.runs), "note": e.note})
    if np.isfinite(e.covariance).all():
        rows = tomlkit.array()
        rows.extend([float(x) for x in row] for row in np.asarray(e.covariance).reshape(2 * k, 2 * k))
        series["covariance"] = rows.multiline(True)
    return tomlkit.dumps(document)


def _parameter(p: Parameter, unit: str) -> dict[str, Any]:
    out: dict[str, Any] = {"value": float(p.value)}
    if all(math.isfinite(x) for x in p.interval):
        out |= {"low": float(p.interval[0]), "high": float(p.interval[1])}
    out |= {"unit": unit, "from": p.origin}
    out |= {"runs": list(p.runs)} if p.runs else {}
    return out | ({"note": p.note} if p.note else {})


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
    try:
        raw = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise UsageError(f"{source} is not valid TOML: {str(error).splitlines()[0]}") from None
    try:
        return _gear(raw)
    except DataError as error:
        raise UsageError(f"{source}: {error}") from None


def _gear(raw: dict[str, Any]) -> GearFile:
    if raw.get("schema") != SCHEMA:
        raise DataError(f"schema = {raw.get('schema')!r}: expected '{SCHEMA}', so this is no gear file")
    _only("the file", raw, TOP)
    numbers = _table(raw, "parameters")
    _only("parameters", numbers, UNITS)
    missing = [name for name in UNITS if name not in numbers]
    if missing:
        raise DataError(f"'parameters.{missing[0]}' is missing; expected a table with a value in {UNITS[missing[0]]}")
    beside = _table(raw, "characteristics") if "characteristics" in raw else {}
    _only("characteristics", beside, CHARACTERISTICS)
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
        kinematic_error=_read_series(_table(raw, "kinematic_error")),
        output=output,
        serial=_text(raw, "serial", ""),
        simulated=simulated,
        made=_text(raw, "made", ""),
        cannot=_texts(raw, "cannot", ""),
        covered=_read_covered(_table(raw, "covered")) if "covered" in raw else None,
    )


def _read_covered(raw: Mapping[str, Any]) -> Covered:
    _only("covered", raw, COVERED)
    ends = {}
    for name, unit in COVERED.items():
        value = raw.get(name)
        numbers = [_number({name: v}, name, "covered") for v in value] if isinstance(value, list) else []
        if len(numbers) != 2 or numbers[0] > numbers[1]:
            raise DataError(f"covered.{name} = {value!r}: expected the least and the largest, {unit}")
        ends[name] = (numbers[0], numbers[1])
    return Covered(**ends)


def _read_parameter(where: str, name: str, raw: Any, unit: str) -> Parameter:
    if not isinstance(raw, dict):
        raise DataError(f'{where} = {raw!r}: expected {{ value = …, unit = "{unit}", from = … }}')
    _only(where, raw, KEYS)
    if raw.get("unit") != unit:
        raise DataError(f"{where}.unit = {raw.get('unit')!r}: expected '{unit}'; units are never converted")
    value = _number(raw, "value", where)
    if value <= 0.0 if name in ("N", "J_m", "J_l", "K", "omega_s") else name.startswith("tau") and value < 0.0:
        raise DataError(f"{where}.value = {value:g} {unit}: expected more than 0")
    interval = (math.nan, math.nan)
    if "low" in raw or "high" in raw:
        interval = (_number(raw, "low", where), _number(raw, "high", where))
        if not interval[0] <= value <= interval[1]:
            raise DataError(f"{where}: {value:g} lies outside its own interval {interval[0]:g} to {interval[1]:g}")
    return Parameter(value, interval, _origin(raw, where), _texts(raw, "runs", where), _text(raw, "note", where))


def _read_series(raw: dict[str, Any]) -> MeasuredSeries:
    where = "kinematic_error"
    _only(where, raw, SERIES_KEYS)
    if raw.get("unit") != "rad":
        raise DataError(f"{where}.unit = {raw.get('unit')!r}: expected 'rad' at the output")
    a, b = _numbers(raw, "a", where), _numbers(raw, "b", where)
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
    return MeasuredSeries(found, covariance, _origin(raw, where), _texts(raw, "runs", where), _text(raw, "note", where))


def _only(where: str, raw: Mapping[str, Any], valid: Iterable[str]) -> None:
    known = sorted(valid)
    for key in raw:
        if key not in known:
            close = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
            hint = f"did you mean '{close[0]}'?" if close else f"expected one of {', '.join(known)}"
            raise DataError(f"unknown key '{key}' in {where}; {hint}")


def _table(raw: Mapping[str, Any], key: str) -> dict[str, Any]:
    if not isinstance(raw.get(key), dict):
        raise DataError(f"[{key}] is missing or no table")
    return dict(raw[key])


def _number(raw: Mapping[str, Any], key: str, where: str) -> float:
    found = number(raw.get(key))
    if math.isnan(found):
        raise DataError(f"{where}.{key} = {raw.get(key)!r}: expected a finite number")
    return found


def _numbers(raw: Mapping[str, Any], key: str, where: str) -> list[float]:
    values = raw.get(key)
    if not isinstance(values, list):
        raise DataError(f"{where}.{key} = {values!r}: expected a list of numbers in rad")
    return [_number({key: v}, key, where) for v in values]


def _origin(raw: Mapping[str, Any], where: str) -> str:
    origin = raw.get("from")
    if origin not in ORIGINS:
        raise DataError(f"{where}.from = {origin!r}: expected one of {', '.join(ORIGINS)}")
    return str(origin)


def _text(raw: Mapping[str, Any], key: str, where: str) -> str:
    value = raw.get(key, "")
    if not isinstance(value, str):
        raise DataError(f"{where}{'.' if where else ''}{key} = {value!r}: expected text")
    return value


def _texts(raw: Mapping[str, Any], key: str, where: str) -> tuple[str, ...]:
    values = raw.get(key, [])
    if not isinstance(values, list) or not all(isinstance(v, str) for v in values):
        raise DataError(f"{where}{'.' if where else ''}{key} = {values!r}: expected a list of texts")
    return tuple(values)
