"""Row 13: what grows when the rig is used for long."""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path
from typing import ClassVar, final

from rig.procedures.kinematic_error import KinematicError
from tests.bench.child import HDRIG, Cost, cost
from tests.bench.figure import AtMost, Figure, Shown
from tests.bench.row import Row
from tests.bench.turns import Rounds
from tests.bench.twin import run
from tests.studies.catalogue import make

LINEAR = AtMost(1.15)  # of the time per sample, or per run, of the tenth
FLAT = AtMost(1.15)  # of the memory of the tenth
TIMES = 10


@final
class Day(Row):
    """An hour stands for the day and for the ten hours: the bench has ten minutes, growth shows over any ten.

    Found and mended: an analysis held whole columns and what it made of them, 90 bytes a row. Columns of more than 17
    minutes now lie in a file without a name and are gone through in stretches: those pages are in view of the process,
    and the machine takes them back when it needs them. A list kept and remembered every run, 2.5 kB each; now it keeps
    a line of each, in a temporary file from 1000 on: 10 000 runs take 1.06 × the memory of 1000, 2.9 × before.

    The day itself was run once (2026-11-21, commit 4c05f8c, 86.4 million rows, virtual clock, nice 10, load 2.6 to 7):
    28.2 to 32.2 s of CPU for every hour of it and 79 MiB from the first to the last, the recorder 26 to 32 MiB; 761 s
    of CPU and 29 min of wall time with the closing of its folder (306 MiB with pages in view; journal 8.6 GB, archive
    2.7 GB). Analysed (commit 4435e5b) in 48 s of CPU with 192 MiB, 5.1 GB of pages of temporary files in view.
    """

    number: ClassVar[int] = 13
    name: ClassVar[str] = "a long day: one run of an hour, analysed; 10 000 runs listed"
    against: ClassVar[str] = "itself at 1/10"

    def measure(self, rounds: Rounds) -> list[Figure]:
        cycles = rounds.size(36, 10)
        with tempfile.TemporaryDirectory() as root:
            short = self._recorded(cycles / TIMES, Path(root))
            long = self._recorded(cycles, Path(root))
            analysed = [cost([*HDRIG, "analyse", str(folder)], allowed=(0, 6)) for folder, _ in (short, long)]
            return [
                Figure("recording on the virtual clock, time per row", [long[1] / short[1] / TIMES], LINEAR),
                *self._both("analyse", analysed[0], analysed[1]),
                *self._listed(short[0], Path(root), rounds),
            ]

    def _recorded(self, cycles: float, root: Path) -> tuple[Path, float]:
        """Slow run of `cycles` cycles of 100 s; CPU time of the loop's process."""
        cycles = max(round(2 * cycles), 1) / 2
        began = time.process_time()
        folder = run(KinematicError(cycles=cycles), root).folder
        return folder, time.process_time() - began

    def _listed(self, folder: Path, root: Path, rounds: Rounds) -> list[Figure]:
        manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
        assert manifest["uid"], "a real run"
        found = []
        for count in (rounds.size(1000, 50), rounds.size(10_000, 500)):
            make(root / f"{count}", folder, count)
            found.append(cost([*HDRIG, "list", str(root / f"{count}")]))
        return self._both("list", found[0], found[1])

    def _both(self, what: str, short: Cost, long: Cost) -> list[Figure]:
        return [
            Figure(
                f"{what}: CPU time of ten times as much, over ten times the tenth's",
                [long.cpu / short.cpu / TIMES],
                LINEAR,
            ),
            Figure(f"{what}: most memory of its own, over the tenth's", [long.own_mib / short.own_mib], FLAT),
            Figure(f"{what}: the same with pages of files in view", [long.peak_mib / short.peak_mib], Shown()),
        ]
