"""Row 9: the tracer."""

from __future__ import annotations

import itertools
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar, final

import numpy as np

from tests.bench.built import Unavailable
from tests.bench.campaign import made, size
from tests.bench.child import HDRIG, Cost, cost
from tests.bench.figure import AtMost, Figure, Shown, not_measured, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds
from tests.bench.worker import Worker

PEERS = ("boosting", "gaussian", "pysindy")
TRACES = {0.25: 1, 1.0: 2, 4.0: 1}  # of a campaign of so many times 45 minutes: the row has five minutes
WALL, MEMORY, LINEAR = AtMost(10.0), AtMost(1536.0), AtMost(1.15)


@dataclass(frozen=True)
class Traced:
    """A campaign of so many rows and minutes, and what its traces cost."""

    rows: int
    minutes: float
    costs: Sequence[Cost]

    @property
    def label(self) -> str:
        """As it was counted."""
        return f"{self.rows / 1e6:.2f} million rows of {self.minutes:.0f} min"


@final
class Trace(Row):
    """Campaigns of the twin of a quarter of, once and four times 45 minutes, the same runs but for their length. The
    peers get the second, every row of its five channels and our split into fitted and held out, and tune themselves as
    in the blind test. They are asked once: that takes a minute.

    They predict what the baseline leaves and stop; hdrig tries 30 effects on every channel, names one or says that it
    cannot, gives intervals and writes the report: all of that is in its time. Found: a fifth of the fastest of them is
    out of reach as long as that is compared; what a person waits for is the wall time. Mended: a cosine of numpy's
    costs 9 ns, of ours 1; resonances waited for divisions; what effects keep with signals, what Arrow had read the runs
    into and heaps of threads stayed until the end, a sixth of a gigabyte. Columns were made one by one and put
    together, what a state leads to along rows that nobody asked for, products of the same rows for every fit anew; one
    process waited for the other at the end of the bank, and while the verdict listened for a clock; all runs were
    joined before it was asked whether unseen ones wander at all, and a coupling's torque was made anew for each of its
    frequencies. Left: the search
    itself, whose two threads take turns at the interpreter more than they share the work, and most of a second of
    imports.
    """

    number: ClassVar[int] = 9
    name: ClassVar[str] = "hdrig trace on a complete campaign"
    against: ClassVar[str] = "the same rows with scikit-learn GP and boosting; pysindy; itself at other lengths"

    def measure(self, rounds: Rounds) -> list[Figure]:
        with tempfile.TemporaryDirectory() as name:
            root, lengths = Path(name), list(TRACES)[: rounds.size(len(TRACES), 1)]
            folders = [made(root, length) for length in lengths]
            traced = [self._traced(f, TRACES[length]) for f, length in zip(folders, lengths, strict=True)]
            asked = min(1, len(folders) - 1)
            beside = self._beside(folders[asked], traced[asked], root)
        return [*beside, *self._alone(traced[asked]), *self._growth(traced)]

    def _traced(self, campaign: Path, times: int) -> Traced:
        command = [*HDRIG, "trace", str(campaign), "--out", str(campaign.parent / "out")]
        return Traced(*size(campaign), [cost(command, allowed=(0, 6)) for _ in range(times)])

    def _beside(self, campaign: Path, ours: Traced, root: Path) -> list[Figure]:
        target, runs = AtMost(0.2), root / "runs"
        runs.mkdir()
        for manifest in campaign.glob("*/manifest.json"):  # the peers read nothing but runs
            (runs / manifest.parent.name).symlink_to(manifest.parent)
        told = {"campaign": str(runs), "trace": str(campaign.parent / "out" / "trace.json")}
        try:
            with Worker("tracing") as peer:
                theirs = {method: float(peer.ask(method=method, **told)["cpu"]) for method in PEERS}
        except Unavailable as why:
            return [not_measured(f"CPU time over {method}", target, str(why)) for method in PEERS]
        mine = [c.cpu for c in ours.costs]
        return [ratio(f"CPU time over {m}, {ours.label}", mine, [theirs[m]] * len(mine), target) for m in PEERS]

    def _alone(self, of: Traced) -> list[Figure]:
        return [
            Figure(f"{of.label}: wall time on two cores", [c.wall for c in of.costs], WALL, "s"),
            Figure(f"{of.label}: CPU time", [c.cpu for c in of.costs], Shown(), "s"),
            Figure(f"{of.label}: most memory of both processes", [c.all_mib for c in of.costs], MEMORY, "MiB"),
        ]

    def _growth(self, traced: Sequence[Traced]) -> list[Figure]:
        """Of time and memory for each row, from each length to the next."""
        out = []
        for few, many in itertools.pairwise(traced):
            times = many.rows / few.rows
            words = f"{times:.1f} times the rows ({many.label})"
            cpu, wall, memory = (
                [
                    np.median([getattr(c, what) for c in many.costs])
                    / np.median([getattr(c, what) for c in few.costs])
                    / times
                ]
                for what in ("cpu", "wall", "all_mib")
            )
            out += [
                Figure(f"{words}: CPU time of a row over that before", cpu, LINEAR),
                Figure(f"{words}: wall time of a row over that before", wall, LINEAR),
                Figure(f"{words}: memory of a row over that before", memory, LINEAR),
                Figure(f"{words}: most memory of both processes", [c.all_mib for c in many.costs], Shown(), "MiB"),
            ]
        return out
