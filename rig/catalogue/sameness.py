"""Which runs measure the same thing, and which of those were taken without anybody touching the rig in between."""

from __future__ import annotations

import json
import math
from typing import Any, NamedTuple

from rig.catalogue.figures import figures
from rig.catalogue.row import Row, number
from rig.core.errors import UsageError

NOT_THE_POINT = ("note", "assembly")  # conditions that do not change what is measured
SAID = {
    "speed_rpm": "{:g} rpm",
    "tau_ext": "{:+g} N·m",
    "depth_mm": "depth {:g} mm",
    "tau_max": "up to {:g} N·m",
}

SPEED = "mean_speed"  # the estimate
DIGITS = 2  # of it: what one constant torque makes of a speed differs by a hundredth from run to run
UNITS = {"s": "s", "hz": "Hz", "mm": "mm", "deg": "deg", "rpm": "rpm", "turns": "turns"}  # by the end of a name


class Point(NamedTuple):
    """Gear, procedure and operating point: runs of the same are comparable."""

    gear: str
    procedure: str
    simulated: bool  # the twin and a real gear never are
    conditions: str  # canonical


class Mounting(NamedTuple):
    """One assembly of the rig: a number within its campaign or, outside of one, within its day (UTC)."""

    within: str
    assembly: str


def point(row: Row) -> Point:
    """What `row` measures, and at which conditions."""
    kept = {key: value for key, value in row.conditions.items() if key not in NOT_THE_POINT}
    if "speed_rpm" not in kept and (speed := _speed(row)) is not None:
        kept["speed_rpm"] = speed
    return Point(row.gear, row.procedure, row.simulated, json.dumps(_rounded(kept), sort_keys=True, default=str))


def _speed(row: Row) -> float | None:
    """What it turned at by its own result, rpm, to two digits: of runs that no manifest states the speed of, those at
    169 and at 507 rpm are no repeats. None where it has none."""
    try:
        found = figures(row.path).get(SPEED)
    except UsageError:  # its result is damaged, which others tell
        return None
    return float(f"{found.value:.{DIGITS}g}") if found is not None and math.isfinite(found.value) else None


def mounting(row: Row) -> Mounting:
    """When two runs share it, nobody took the rig apart between them."""
    assembly = row.conditions.get("assembly", "")
    return Mounting(row.campaign or row.started_utc[:10], json.dumps(assembly, default=str))


def words(at: Point) -> str:
    """For people: "kinematic-error, 9.6 rpm, +5 N·m"."""
    conditions = json.loads(at.conditions)
    parts = [at.procedure.replace("_", "-")]
    for key, value in conditions.items():
        match value:
            case bool():
                parts += ["locked"] if key == "output_locked" and value else [] if key == "output_locked" else [key]
            case int() | float() if key in SAID:
                parts += [SAID[key].format(value)] if value or key == "speed_rpm" else []
            case int() | float():
                parts.append(_named(key, value))
    return ", ".join(parts)


def _named(key: str, value: float) -> str:
    """ "settle 3 s" of settle_s."""
    name, _, end = key.rpartition("_")
    if end in UNITS and name:
        return f"{name.replace('_', ' ')} {value:g} {UNITS[end]}"
    return f"{key.replace('_', ' ')} {value:g}"


def beside(key: str, a: object, b: object) -> str:
    """One condition of two runs: "speed 9.6 rpm and 300 rpm"; a value that is no number stands as it is."""
    name, _, end = key.rpartition("_")
    unit = UNITS.get(end, "") if name else ""
    if key.startswith("tau_"):
        name, unit = key, "N·m"
    shown = key if key.startswith("tau_") else (name if unit else key).replace("_", " ")
    said = [str(x) if (n := number(x)) is None else f"{n:g} {unit}".strip() for x in (a, b)]
    return f"{shown} {' and '.join(said)}"


def _rounded(value: Any) -> Any:
    """Numbers to six digits: 0.1 + 0.2 and 0.3 are one speed."""
    match value:
        case bool() | str() | None:
            return value
        case int() | float():
            found = number(value)
            return "no number" if found is None else float(f"{found:.6g}")
        case list():
            return [_rounded(v) for v in value]
        case dict():
            return {k: _rounded(v) for k, v in value.items()}
        case _:
            return str(value)
