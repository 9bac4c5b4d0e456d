"""Row 9: the tracer."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import ClassVar, final

from tests.bench.built import Unavailable
from tests.bench.child import HDRIG, Cost, cost
from tests.bench.figure import AtMost, Figure, Shown, not_measured, ratio
from tests.bench.row import Row
from tests.bench.turns import Rounds, Side, take_turns
from tests.bench.worker import Worker

PEERS = ("boosting", "gaussian", "pysindy")
CASE = ("--kind", "single", "--effect", "stribeck_friction", "--seed", "7")


@final
class Trace(Row):
    """The blind test's campaign of 36 runs for all; the peers are given every row, and tune themselves as there.

    They predict what the baseline leaves and stop; hdrig tries 30 effects on every channel, names one or says that it
    cannot, gives intervals and writes the report: all of that is in its time. Found: a fifth of the fastest of them is
    out of reach as long as that is compared; what a person waits for is the last figure.
    """

    number: ClassVar[int] = 9
    name: ClassVar[str] = "hdrig trace on a complete campaign"
    against: ClassVar[str] = "the same evidence with scikit-learn GP and boosting; pysindy"

    def measure(self, rounds: Rounds) -> list[Figure]:
        with tempfile.TemporaryDirectory() as root:
            cost([sys.executable, "-m", "tests.blind.generate", *CASE, "--out", root])
            (campaign,) = [p for p in Path(root).iterdir() if p.is_dir() and p.name != "truth"]
            return [*self._beside(campaign, Path(root), rounds), *self._long(Path(root), rounds)]

    def _trace(self, campaign: Path, root: Path) -> Cost:
        return cost([*HDRIG, "trace", str(campaign), "--out", str(root / "out")], allowed=(0, 6))

    def _beside(self, campaign: Path, root: Path, rounds: Rounds) -> list[Figure]:
        target = AtMost(0.2)
        try:
            with Worker("tracing") as peer:
                sides: dict[str, Side] = {"ours": lambda: self._trace(campaign, root).cpu}
                sides |= {m: lambda m=m: float(peer.ask(method=m, campaign=str(campaign))["cpu"]) for m in PEERS}
                found = take_turns(sides, min(rounds.count, 2))
        except Unavailable as why:
            return [not_measured(f"CPU time over {method}", target, str(why)) for method in PEERS]
        return [ratio(f"CPU time over {method}", found["ours"], found[method], target) for method in PEERS]

    def _long(self, root: Path, rounds: Rounds) -> list[Figure]:
        """The program's own complete campaign on the twin, 1 kHz."""
        if rounds.quick:
            return [not_measured("1.5 million samples, wall time on two cores", AtMost(10.0), "quick")]
        cost([*HDRIG, "campaign", "complete", "--clock", "virtual", "--out", str(root / "complete")], allowed=(0, 1, 6))
        (campaign,) = (root / "complete").iterdir()
        found = [self._trace(campaign, root) for _ in range(2)]
        return [
            Figure("1.5 million samples, wall time on two cores", [c.wall for c in found], AtMost(10.0), "s"),
            Figure("1.5 million samples, CPU time", [c.cpu for c in found], Shown(), "s"),
        ]
