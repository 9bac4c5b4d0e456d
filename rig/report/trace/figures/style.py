"""How before, after, measured and floor are drawn, the same in every figure of a trace: by dash and width, not by
colour alone.
"""

from __future__ import annotations

from typing import Any

from matplotlib.lines import Line2D

from rig.report.palette import LIGHT

BEFORE: dict[str, Any] = {"color": LIGHT["reverse"], "lw": 1.3, "ls": (0, (5, 2))}
AFTER: dict[str, Any] = {"color": LIGHT["forward"], "lw": 1.3, "ls": "-"}
MEASURED: dict[str, Any] = {"color": LIGHT["axis"], "lw": 3.6, "ls": "-", "alpha": 0.6}
FLOOR: dict[str, Any] = {"color": LIGHT["level"], "lw": 1.4, "ls": (0, (2, 2))}


def handle(style: dict[str, Any], label: str) -> Line2D:
    """An entry of a key."""
    return Line2D([], [], label=label, **style)
