"""The story of a loop as one page: self-contained HTML, read without network or script, on paper as on a phone."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rig.analysis.tracing.fit.channels import SENSOR_NAMES
from rig.core.errors import NotReady, UsageError
from rig.report import words as run_words
from rig.report.closing.changes import changes, sizes
from rig.report.closing.rounds import DRAWING, curves
from rig.report.numbers import counted
from rig.report.rows import measured
from rig.report.shell import css, environment, plot
from rig.report.words import Ruling, humanise
from rig.runfile.manifest import contents, parse, told, write_atomic

HERE = Path(__file__).parent
SOURCE: Final = "close-loop.json"
NAME: Final = "close-loop.html"
RULINGS: Final = {
    "nothing_missing": Ruling("✓", "Nothing is missing", "good"),
    "explained": Ruling("✓", "Explained", "good"),
    "unknown": Ruling("?", "Something is left that nobody can name", "warn"),
    "undecided": Ruling("?", "Not decided", "warn"),
    "budget": Ruling("…", "The budget of rig time is spent", "warn"),
    "stopped": Ruling("■", "Stopped", "plain"),
    "open": Ruling("…", "Not finished", "plain"),
}
POOLED: Final = (
    ("kinematic_error_rms_arcsec", "floor_kinematic_error_arcsec", "Kinematic error", "arcsec"),
    ("tau_m_rms", "floor_tau_m", "Motor torque", "N·m"),
    ("tau_l_rms", "floor_tau_l", "Shaft torque", "N·m"),
)


def write(folder: Path) -> Path:
    """Write `folder`/close-loop.html from the close-loop.json there. Raises UsageError without one, NotReady."""
    path = folder / SOURCE
    try:
        story = parse(contents(path))
    except (OSError, ValueError) as error:
        raise UsageError(f"{path} cannot be read: {error}") from None
    with told(NotReady, f"{folder / NAME} cannot be written"):
        write_atomic(folder / NAME, render(story).encode(errors="replace"))
    return folder / NAME


def render(story: Mapping[str, Any]) -> str:
    """The page as text, from what close-loop.json says alone."""
    origin = run_words.origin("sim" if story["simulated"] else "can")
    rounds = story["rounds"]
    drawn = plot(DRAWING, curves(rounds), origin.mark) if rounds else None
    view = {
        "story": story,
        "origin": origin,
        "ruling": RULINGS[story["end"]],
        "minutes": rounds[-1]["minutes"] if rounds else 0.0,
        "rounds": [_round(r, before) for r, before in zip(rounds, [None, *rounds], strict=False)],
        "heads": [word for c, word in SENSOR_NAMES.items() if any(c in r["over_floor_after"] for r in rounds)],
        "drawn": drawn,
        "errors": _errors(rounds[-1]) if rounds else [],
        "css": css(story["campaign"], origin.mark, HERE),
    }
    return environment(HERE).get_template("page.html").render(view)


def _parts(r: Mapping[str, Any]) -> str:
    """That some of the held-out ones were fitted with their rest; nothing of a story written before that was told."""
    parts = r.get("in_part", 0)
    return f" ({counted(parts, 'part')} of fitted runs)" if parts else ""


def _round(r: Mapping[str, Any], last: Mapping[str, Any] | None) -> dict[str, Any]:
    before, after = r["over_floor_before"], r["over_floor_after"]
    ratios = [(word, before[c], after[c]) for c, word in SENSOR_NAMES.items() if c in before and c in after]
    return {
        "number": r["number"],
        "status": r["status"].replace("_", " "),
        "minutes": r["minutes"],
        "made": r["made"],
        "runs": f"{counted(r['fitted'], 'run')} fitted, {r['held_out']} held out{_parts(r)}",
        "sentence": r["sentence"],
        "named": ", ".join(humanise(e).lower() for e in r["effects"]) or "–",
        "cells": {word: f"{a:.2f} → {b:.2f}" for word, a, b in ratios},
        "changed": [] if last is None else changes(last, r),
        "sizes": sizes(r, last),
        "asked": _asked(r["asked"]) if r["asked"] else "",
        "next": r["words"],
        "refused": r["refused"],
    }


def _asked(asked: Mapping[str, Any]) -> str:
    """Procedure, its conditions with units, and why."""
    shown = (measured(key, value) for key, value in asked["conditions"].items())
    at = ", ".join(f"{row.name[:1].lower()}{row.name[1:]} {row.value}" for row in shown)
    return f"{humanise(asked['procedure'])}{f' at {at}' if at else ''}: {asked['because']}"


def _errors(last: Mapping[str, Any]) -> list[tuple[str, ...]]:
    """Channel, before, after, floor, each with its unit; RMS on held-out runs."""
    before, after = last["pooled_before"], last["pooled_after"]
    return [
        (label, *(f"{values[key]:.3g} {unit}" for values, key in ((before, rms), (after, rms), (before, floor))))
        for rms, floor, label, unit in POOLED
        if before.get(rms) is not None and after.get(rms) is not None and before.get(floor) is not None
    ]
