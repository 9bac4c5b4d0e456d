"""Benches, procedures and plans as a page offers them: names, units, defaults and what each parameter means."""

from __future__ import annotations

import inspect
import math
import re
from dataclasses import MISSING, Field, fields
from functools import cache
from pathlib import Path
from typing import Any

from rig.bench import BENCHES
from rig.campaign.plan import PLANS, read_plan
from rig.procedures import CATALOGUE, procedure_class

UNITS = ("N·m/s", "N·m", "rad/s", "deg", "rad", "rpm", "Hz", "turns", "mm", "s", "1")  # longest first
SUFFIXES = {"_deg": "deg", "_rpm": "rpm", "_hz": "Hz", "_mm": "mm", "_s": "s"}
COMMENT = re.compile(r"^    (\w+): [^#\n]*#\s*(.+)$", re.M)  # a field of a dataclass and what stands beside it
GROUPS = {
    "sign-and-scale": "checks", "weigh": "checks", "lock-check": "checks", "unwind": "checks", "step-test": "checks",
    "standstill": "checks", "held-standstill": "checks", "sentinel": "checks", "jog": "checks",
}  # fmt: skip


@cache
def procedures() -> list[dict[str, Any]]:
    """Every procedure of the catalogue."""
    return [_procedure(name) for name in CATALOGUE]


def _procedure(name: str) -> dict[str, Any]:
    kind = procedure_class(name)
    told = dict(COMMENT.findall(inspect.getsource(kind)))
    first = (kind.__doc__ or "").strip().partition("\n")[0]
    return {
        "name": name,
        "title": name.replace("-", " "),
        "summary": re.split(r" {3,}\[", first)[0],
        "group": GROUPS.get(name, "measurements"),
        "needs_lock": kind.output_locked,
        "parameters": [_parameter(f, told.get(f.name, "")) for f in fields(kind)],  # type: ignore[arg-type]
    }


def _parameter(field: Field[Any], told: str) -> dict[str, Any]:
    default = None if field.default is MISSING else field.default
    unit = next((unit for end, unit in SUFFIXES.items() if field.name.endswith(end)), "")
    if not unit:
        unit = next((u for u in UNITS if re.match(rf"{re.escape(u)}(?![\w·/])", told)), "")
    meaning = re.sub(rf"^{re.escape(unit)}(?![\w·/])[\s,:]*", "", told) if unit else told
    return {
        "name": field.name,
        "type": type(default).__name__,
        "unit": unit,
        "default": _plain(default),
        "meaning": meaning,
        "signed": bool(field.metadata.get("signed", False)),
    }


def _plain(default: Any) -> Any:
    """As JSON has it; a default that is no number stands for something not given."""
    if isinstance(default, tuple):
        return list(default)
    return None if isinstance(default, float) and not math.isfinite(default) else default


@cache
def plans() -> list[dict[str, Any]]:
    """Plans that ship."""
    return [
        {"name": name, "summary": read_plan(name).file.title} for name in sorted(p.stem for p in PLANS.glob("*.toml"))
    ]


def benches(offered: str) -> list[str]:
    """What can be connected: the one the server was started for first, then those that ship."""
    ships = sorted(p.stem for p in Path(BENCHES).glob("*.toml"))
    return [offered, *(name for name in ships if name != offered)]


def catalogue(offered: str) -> dict[str, Any]:
    """All of it."""
    return {"benches": benches(offered), "procedures": procedures(), "plans": plans()}
