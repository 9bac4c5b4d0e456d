"""Row 12: what a person waits for at the prompt."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import ClassVar, final

from rig.procedures.kinematic_error import KinematicError
from tests.bench.child import HDRIG, cost
from tests.bench.figure import AtMost, Figure, Shown, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds, Side, take_turns
from tests.bench.twin import run

PYTHON = sys.executable


def side(command: Sequence[str]) -> Side:
    """CPU time of a process [s]."""
    return lambda: cost(command, allowed=(0, 6)).cpu  # 6: a run too short to be judged, when quick


@final
class Commands(Row):
    """`--help` lists the verbs from a table and imports none of them; each verb imports what it needs.

    Found and mended: an analysis loaded scipy.interpolate, scipy.optimize and numba for springs and simulations it did
    not make, 40 % of its time; pyarrow imported pandas, where that is installed, for columns it only had to hand over;
    pydantic came with one function that needs none of it; Python searched what was imported for garbage, again and
    again. Harmonics of a block were made in fresh memory, whose pages cost five times the arithmetic, and so were the
    columns of each revolution (a third of the analysis); matplotlib wrote a page of help for every kind of artist as it
    was imported (0.1 s); analyses of other procedures were imported with those of the run's own. Page and result are
    the same to the byte, CPU time 0.88 of before in twelve rounds. Ticks were 40 % of the figures' time, for each was
    made of five artists: one is moved along each axis now; and as matplotlib is imported, kinds of artists get no
    signature of all that can be set: 0.76 of before. A third of the figures' time went into words laid out anew in each
    of them, paths written with six decimals to be read and rounded, and groups that were taken away again: 0.88 of
    before. What is left is matplotlib still: two fifths of all in six figures, each in two widths, a sixth in its
    import.
    """

    number: ClassVar[int] = 12
    name: ClassVar[str] = "hdrig --help; hdrig analyse on a 200 s run, warm"
    against: ClassVar[str] = "python -c pass; importing numpy"

    def measure(self, rounds: Rounds) -> list[Figure]:
        start = take_turns({"help": side([*HDRIG, "--help"]), "pass": side([PYTHON, "-c", "pass"])}, 2 * rounds.count)
        with tempfile.TemporaryDirectory() as root:
            seconds = rounds.size(200, 20)
            folder = run(KinematicError(frequency=2.0 / seconds, amplitude_deg=7.2 * seconds), Path(root)).folder
            sides = {
                "analyse": side([*HDRIG, "analyse", str(folder)]),
                "numpy": side([PYTHON, "-c", "import numpy"]),
            }
            analysed = take_turns(sides, rounds.count)
        return [
            ratio("hdrig --help over python -c pass", start["help"], start["pass"], AtMost(4.0)),
            Figure("hdrig analyse, report included", analysed["analyse"], AtMost(1.0), "s of CPU"),
            ratio("hdrig analyse over importing numpy", analysed["analyse"], analysed["numpy"], Shown()),
        ]
