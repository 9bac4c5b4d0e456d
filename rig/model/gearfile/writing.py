"""A gear file as TOML: every number with its unit; what is written is read back as the same value, bit by bit."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from rig.core.errors import UsageError
from rig.model.gearfile.content import CHARACTERISTICS, COVERED, SCHEMA, UNITS, GearFile, Parameter


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
