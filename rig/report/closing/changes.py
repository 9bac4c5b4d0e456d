"""What a round found that the one before it had not: verdict, names, errors, sizes of the effects."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.model.effect import Parameter
from rig.report.numbers import ABSENT, counted
from rig.report.trace.sizes import said
from rig.report.trace.words import gloss
from rig.report.words import humanise

APART: Final = 0.1  # of an error over its floor: less is what other held-out runs make of it


def changes(last: Mapping[str, Any], now: Mapping[str, Any]) -> list[str]:
    """One sentence each; says so where nothing changed."""
    out = []
    if last["status"] != now["status"]:
        out.append(f"The verdict went from {_plain(last['status'])} to {_plain(now['status'])}.")
    new, gone = ([e for e in a["effects"] if e not in b["effects"]] for a, b in ((now, last), (last, now)))
    out += [f"Named now: {_listed(new)}."] if new else []
    out += [f"Named no more: {_listed(gone)}."] if gone else []
    before, after = last["over_floor_after"], now["over_floor_after"]
    for sensor, word in SENSOR_NAMES.items():
        if sensor in before and sensor in after and abs(after[sensor] - before[sensor]) > APART:
            on = counted(now["held_out"], "held-out run")
            on += f" instead of {last['held_out']}" if now["held_out"] != last["held_out"] else ""
            out.append(
                f"The {word} left went from {before[sensor]:.2f} to {after[sensor]:.2f} times its floor, on {on}."
            )
    return out or ["Nothing changed but the number of runs."]


def sizes(now: Mapping[str, Any], last: Mapping[str, Any] | None) -> list[tuple[str, str, str]]:
    """(parameter, size a round before, size now), each with unit and interval; "–" where it was not there."""
    old = {} if last is None else _parameters(last)
    return [(name, old.get(name, ABSENT), size) for name, size in _parameters(now).items()]


def _parameters(r: Mapping[str, Any]) -> dict[str, str]:
    return {
        ", ".join(part for part in (f"{humanise(effect)}: {name}", gloss(effect, name, p["unit"])) if part): said(
            Parameter(name, p["value"], tuple(p["ci95"]), p["unit"])
        )
        for effect, found in r["parameters"].items()
        for name, p in found.items()
        if p["value"] is not None and None not in p["ci95"]
    }


def _plain(status: str) -> str:
    return status.replace("_", " ")


def _listed(names: list[str]) -> str:
    return ", ".join(humanise(name).lower() for name in names)
