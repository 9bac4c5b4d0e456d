"""Benches, procedures and plans as a page offers them: names, units, defaults and what each parameter means."""

from __future__ import annotations

import math
import re
from functools import cache
from pathlib import Path
from typing import Any

from rig.bench import BENCHES
from rig.campaign.plan import PLANS, read_plan
from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.campaign.sweeps import sweep_class
from rig.parameters.told import Told, told
from rig.procedures import CATALOGUE, procedure_class


@cache
def procedures() -> list[dict[str, Any]]:
    """Every procedure of the catalogue."""
    return [_procedure(name) for name in CATALOGUE]


def _procedure(name: str) -> dict[str, Any]:
    kind = procedure_class(name)
    return {**_offered(name, kind, "checks" if kind.checks else "measurements"), "needs_lock": kind.output_locked}


def _offered(name: str, kind: type[Any], group: str) -> dict[str, Any]:
    first = (kind.__doc__ or "").strip().partition("\n")[0]
    return {
        "name": name,
        "title": name.replace("-", " "),
        "summary": re.split(r" {3,}\[", first)[0],
        "group": group,
        "parameters": [_parameter(t) for t in told(kind)],
    }


def _parameter(told: Told) -> dict[str, Any]:
    return {
        "name": told.name,
        "type": type(told.default).__name__,
        "unit": told.unit,
        "default": _plain(told.default),
        "meaning": told.meaning,
        "signed": told.signed,
    }


def _plain(default: Any) -> Any:
    """As JSON has it; a default that is no number stands for something not given."""
    if isinstance(default, tuple):
        return list(default)
    return None if isinstance(default, float) and not math.isfinite(default) else default


@cache
def plans() -> list[dict[str, Any]]:
    """Plans that ship, then the sweeps that are none of them, with their parameters."""
    ships = sorted(p.stem for p in PLANS.glob("*.toml"))
    found: list[dict[str, Any]] = [{"name": name, "summary": read_plan(name).file.title} for name in ships]
    return [*found, *(_offered(name, sweep_class(name), "sweeps") for name in SWEEPS if name not in ships)]


def benches(offered: str) -> list[str]:
    """What can be connected: the one the server was started for first, then those that ship."""
    ships = sorted(p.stem for p in Path(BENCHES).glob("*.toml"))
    return [offered, *(name for name in ships if name != offered)]


def catalogue(offered: str) -> dict[str, Any]:
    """All of it."""
    return {"benches": benches(offered), "procedures": procedures(), "plans": plans()}
