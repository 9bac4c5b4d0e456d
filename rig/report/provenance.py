"""Who, what, when, with what: every key of a manifest as a row, known or not."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from rig.core.numbers import number
from rig.report.numbers import duration, quantity
from rig.report.rows import Row, flat, measured, show, table, utc
from rig.report.words import humanise, kind, origin, status

TOLD = {
    "duration",
    "uid",
    "procedure",
    "status",
    "exit_reason",
    "started_utc",
    "ended_utc",
    "backend",
    "encoders",
    "software",
    "schema",
}
APART = {"files", "conditions", "declared", "verdict"}  # shown in tables of their own


def software(manifest: Mapping[str, Any]) -> str:
    """Version, commit, and whether the tree was clean; "" when the manifest does not say."""
    found = table(manifest.get("software"))
    if not found:
        return ""
    parts = [f"hdrig {found['version']}"] if found.get("version") else []
    parts += [f"commit {found['commit']}"] if found.get("commit") else []
    parts += ["with uncommitted changes"] if found.get("dirty") else ["clean"] if "dirty" in found else []
    return ", ".join(parts)


def provenance(manifest: Mapping[str, Any], folder: str) -> list[Row]:
    """Who, what, when, with what. Every key of the manifest ends up in a row, known or not."""
    gear, encoders = table(manifest.get("gear")), table(manifest.get("encoders"))
    backend = manifest.get("backend")
    known = [
        Row("Run", folder, True),
        Row("Unique id", show(manifest.get("uid")), True),
        Row("Procedure", kind(str(manifest.get("procedure", "unknown")))),
        Row("Ending", status(manifest) or "unknown"),
        Row("Started", utc(manifest["started_utc"]) if manifest.get("started_utc") else "unknown"),
        *([Row("Ended", utc(manifest["ended_utc"]))] if manifest.get("ended_utc") else []),
        *_length(manifest),
        Row("Origin", f"{origin(backend).word.capitalize()}, backend {show(backend)}"),
        Row("Gear", show(gear.get("serial"))),
        Row("Gear ratio", show(gear.get("ratio"))),
        Row("Output of the gear", show(gear.get("output"))),
        *(measured(str(k), v) for k, v in encoders.items()),
        Row("Software", software(manifest) or "unknown"),
        Row("Schema", show(manifest.get("schema"))),
    ]
    return known + _rest(manifest)


def _rest(manifest: Mapping[str, Any]) -> list[Row]:
    """Every key that no row above and no table of its own has shown."""
    rest = {k: v for k, v in manifest.items() if k not in TOLD | APART | {"gear"}}
    known_software = ("version", "commit", "dirty")
    rest |= {f"software.{k}": v for k, v in table(manifest.get("software")).items() if k not in known_software}
    rest |= {f"gear.{k}": v for k, v in table(manifest.get("gear")).items() if k not in ("serial", "ratio", "output")}
    proof = dict(table(rest.get("proof")))
    difference, error = number(proof.get("shaft_torque_difference")), number(proof.get("shaft_torque_error"))
    apart_rows = []
    if math.isfinite(difference) and math.isfinite(error):  # one row: the error stands behind the difference
        rest["proof"] = {k: v for k, v in proof.items() if k not in ("shaft_torque_difference", "shaft_torque_error")}
        apart_rows = [Row("proof.shaft_torque_difference", quantity(difference, 2 * error, "N·m"))]
    return apart_rows + [Row(name if "." in name else humanise(name), value) for name, value in flat(rest)]


def _length(manifest: Mapping[str, Any]) -> list[Row]:
    """How long the run took; on a virtual clock that is not what lies between its start and its end."""
    seconds = manifest.get("duration")
    if not math.isfinite(number(seconds)):
        return []
    virtual = table(manifest.get("loop")).get("clock") == "virtual"
    return [Row("Duration", duration(number(seconds)) + (" on a virtual clock" if virtual else ""))]
