"""A compensation as one page: the load's error without and with it, measured and predicted, speed by speed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from markupsafe import Markup

from rig.core.errors import NotReady, UsageError
from rig.report import words as run_words
from rig.report.shell import css, environment
from rig.runfile.manifest import contents, parse, told, write_atomic

HERE = Path(__file__).parent
SOURCE: Final = "compensation.json"
NAME: Final = "compensation.html"
WIDE, HIGH, EDGE = 720.0, 220.0, 44.0  # px of a drawing, and its margin for the axes


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
        "speeds": [_speed(s) for s in found["speeds"]],
        "css": css(name, origin.mark, HERE),
    }
    return environment(HERE).get_template("compensation.html").render(view)


def _speed(s: Mapping[str, Any]) -> dict[str, Any]:
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
        "drawing": Markup(_drawing(s["measured"])),
    }


def _predicted(said: Mapping[str, Any], key: str) -> str:
    low, high = said[f"{key}_ci95"]
    return f"{said[key]:.2f} ({low:.2f} to {high:.2f})"


def _drawing(measured: Mapping[str, Any]) -> str:
    """Both curves over the motor turn, forth and back, on one scale."""
    curves = [(which, way, np.array(measured[which][f"{way}_arcsec"])) for which in ("without", "with")
              for way in ("forth", "back")]  # fmt: skip
    most = max(float(np.abs(c).max()) for _, _, c in curves) * 1.05
    lines = []
    for which, way, c in curves:
        x = EDGE + (np.arange(c.size) + 0.5) / c.size * (WIDE - 2 * EDGE)
        y = HIGH / 2 - c / most * (HIGH / 2 - 14)
        points = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y, strict=True))
        ink = "var(--muted)" if which == "without" else "var(--forward)"
        dash = ' stroke-dasharray="5 3"' if way == "back" else ""
        lines.append(f'<polyline fill="none" stroke="{ink}" stroke-width="1.6"{dash} points="{points}"/>')
    axis = (
        f'<line x1="{EDGE}" x2="{WIDE - EDGE}" y1="{HIGH / 2}" y2="{HIGH / 2}" stroke="var(--axis)"/>'
        f'<text x="2" y="18" fill="currentColor" font-size="12">{most / 1.05:+.0f}″</text>'
        f'<text x="2" y="{HIGH - 6}" fill="currentColor" font-size="12">{-most / 1.05:+.0f}″</text>'
        f'<text x="{EDGE}" y="{HIGH - 2}" fill="currentColor" font-size="12">0°</text>'
        f'<text x="{WIDE - EDGE - 28}" y="{HIGH - 2}" fill="currentColor" font-size="12">360°</text>'
    )
    label = "Error of the load over one turn of the motor, without and with compensation"
    head = f'<svg class="plot" viewBox="0 0 {WIDE:g} {HIGH:g}" role="img" aria-label="{label}">'
    return f"{head}{axis}{''.join(lines)}</svg>"
