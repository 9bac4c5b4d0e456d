"""How before, after, measured and floor are drawn, the same in every figure of a trace: by dash and width, not by
colour alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from matplotlib.lines import Line2D

from rig.analysis.tracing.runs.holdout import whole_run
from rig.report.figures.canvas import Frame
from rig.report.palette import LIGHT

BEFORE: dict[str, Any] = {"color": LIGHT["reverse"], "lw": 1.3, "ls": (0, (5, 2))}
AFTER: dict[str, Any] = {"color": LIGHT["forward"], "lw": 1.3, "ls": "-"}
MEASURED: dict[str, Any] = {"color": LIGHT["axis"], "lw": 3.6, "ls": "-", "alpha": 0.6}
FLOOR: dict[str, Any] = {"color": LIGHT["level"], "lw": 1.4, "ls": (0, (2, 2))}
LETTER = 6.4  # px, a letter of a label
TAIL = 8  # letters at the end of a name that is cut: there it differs from the others
TITLE = (56, 20)  # letters of a run's name in a title that says more, on a wide and a narrow page


def handle(style: dict[str, Any], label: str) -> Line2D:
    """An entry of a key."""
    return Line2D([], [], label=label, **style)


def labels(runs: Sequence[str], most: int) -> list[str]:
    """Names of at most so many letters; what is too long loses first what makes it a part of a run, then its middle."""
    parts = [whole_run(run) for run in runs]
    names = parts if len(set(parts)) == len(runs) else list(runs)
    return [n if len(n) <= most else f"{n[: most - TAIL - 1]}…{n[-TAIL:]}" for n in names]


def titled(run: str, frame: Frame) -> str:
    """Name of a run in a title."""
    most = TITLE[1] if frame.narrow else TITLE[0]
    return run if len(run) <= most else labels([run], most)[0]
