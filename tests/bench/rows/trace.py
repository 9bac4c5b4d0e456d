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
from tests.bench.turns import Rounds, take_turns
from tests.bench.worker import Worker

PEERS = ("boosting", "gaussian", "pysindy")
CASE = ("--kind", "single", "--effect", "stribeck_friction", "--seed", "7")


@final
class Trace(Row):
    """The blind test's campaign of 36 runs for both; the peers get 400 rows of each run, as in tests/blind/peers.

    They predict what the baseline leaves; only hdrig names it, gives intervals and writes the report: that is in its
    time. They are offered fewer rows because with all of them they would take hours.
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
        target, figures = AtMost(0.2), []
        for method in PEERS:
            try:
                with Worker("tracing") as peer:
                    sides = {
                        "ours": lambda: self._trace(campaign, root).cpu,
                        "theirs": lambda peer=peer, method=method: peer.ask(method=method, campaign=str(campaign))[
                            "cpu"
                        ],
                    }
                    found = take_turns(sides, min(rounds.count, 2))
                figures.append(ratio(f"CPU time over {method}", found["ours"], found["theirs"], target))
            except Unavailable as why:
                figures.append(not_measured(f"CPU time over {method}", target, str(why)))
        return figures

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
