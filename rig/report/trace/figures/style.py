"""How before, after, measured and floor are drawn, the same in every figure of a trace: by dash and width, not by
colour alone.
"""

from __future__ import annotations

from typing import Any

from matplotlib.lines import Line2D

from rig.report.palette import LIGHT

BEFORE: dict[str, Any] = {"color": LIGHT["reverse"], "lw": 1.5, "ls": (0, (5, 2))}
AFTER: dict[str, Any] = {"color": LIGHT["forward"], "lw": 2.0, "ls": "-"}
MEASURED: dict[str, Any] = {"color": LIGHT["axis"], "lw": 3.2, "ls": "-", "alpha": 0.55}
FLOOR: dict[str, Any] = {"color": LIGHT["level"], "lw": 1.4, "ls": (0, (2, 2))}


def handle(style: dict[str, Any], label: str) -> Line2D:
    """An entry of a key."""
    return Line2D([], [], label=label, **style)
