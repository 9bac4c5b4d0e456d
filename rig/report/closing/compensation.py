"""A compensation as one page: the load's error without and with it, measured and predicted, speed by speed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from rig.core.errors import NotReady, UsageError
from rig.report import words as run_words
from rig.report.closing.following import DRAWING
from rig.report.figures import Frame, svg
from rig.report.shell import css, environment
from rig.runfile.manifest import contents, parse, told, write_atomic

HERE = Path(__file__).parent
SOURCE: Final = "compensation.json"
NAME: Final = "compensation.html"
WIDE: Final = 720.0  # px of a drawing
WAYS: Final = ("forth", "back")


def write(folder: Path) -> Path:
    """Write `folder`/compensation.html from the compensation.json there. Raises UsageError without one, NotReady."""
    try:
        found = parse(contents(folder / SOURCE))
    except (OSError, ValueError) as error:
        raise UsageError(f"{folder / SOURCE} cannot be read: {error}") from None
    with told(NotReady, f"{folder / NAME} cannot be written"):
        write_atomic(folder / NAME, render(found, folder.name).encode(errors="replace"))
    return folder / NAME


def render(found: Mapping[str, Any], name: str) -> str:
    """The page as text, from what compensation.json says alone."""
    origin = run_words.origin("sim" if found["simulated"] else "can")
    view = {
        "name": name,
        "origin": origin,
        "gear": found["gear"],
        "zero": found["zero"]["sentence"],
        "speeds": [_speed(s, origin.mark, f"c{k}-") for k, s in enumerate(found["speeds"], 1)],
        "css": css(name, origin.mark, HERE),
    }
    return environment(HERE).get_template("compensation.html").render(view)


def _speed(s: Mapping[str, Any], mark: str, prefix: str) -> dict[str, Any]:
    rows = []
    for key, label in (("rms", "RMS"), ("peak_to_peak", "Peak to peak")):
        measured = [s["measured"][which][key] for which in ("without", "with")]
        told_of = [f"{m['value']:.2f} ({m['low']:.2f} to {m['high']:.2f})" for m in measured]
        rows.append((label, *told_of, *(_predicted(s["predicted"][which], key) for which in ("without", "with"))))
    return {
        "rpm": f"{s['speed_rpm']:g}",
        "turns": s["measured"]["with"]["turns"],
        "measured": f"{s['improvement']['measured']:.1f}",
        "predicted": f"{s['improvement']['predicted']:.1f}",
        "rows": rows,
        "unlike": s["unlike_the_model"],
        "drawing": Markup(_drawing(s["measured"], mark, prefix)),
    }


def _predicted(said: Mapping[str, Any], key: str) -> str:
    low, high = said[f"{key}_ci95"]
    return f"{said[key]:.2f} ({low:.2f} to {high:.2f})"


def _drawing(measured: Mapping[str, Any], mark: str, prefix: str) -> str:
    """Both curves over the motor turn, forth and back, on one scale."""
    found = {f"{which}.{way}": measured[which][f"{way}_arcsec"] for which in ("without", "with") for way in WAYS}
    curves = {name: np.asarray(values, dtype=np.float64) for name, values in found.items()}
    return svg(DRAWING, curves, Frame(WIDE, mark), prefix=prefix) or ""
