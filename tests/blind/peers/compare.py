"""Peers on the cases of a suite: `python -m tests.blind.peers.compare DIR [--cases N] [--table FILE]`."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.blind.peers.data import Split, splits

if TYPE_CHECKING:
    from tests.blind.peers.peer import Peer

KINDS = ("single", "single_other", "crowded", "pair")


@dataclass(frozen=True)
class Outcome:
    """One method on one case: held-out error over floor of the worst channel, before and after, and families named."""

    before: float
    after: float
    families: int
    seconds: float


def peers() -> list[Peer]:
    """All of them; ImportError when the extra `peers` is not installed."""
    from tests.blind.peers.black_box import Boosting, Gaussian
    from tests.blind.peers.frols import Frols
    from tests.blind.peers.rich_friction import RichFriction
    from tests.blind.peers.sparse import SparseGeneric, SparsePhysical

    return [SparsePhysical(), SparseGeneric(), Frols(), Gaussian(), Boosting(), RichFriction()]


def over_floor(error: np.ndarray, split: Split, floor: Mapping[str, float]) -> float:
    """Root mean square over held-out runs of RMS over that run's floor (the same run's residual without the effect)."""
    names = [name for name in dict.fromkeys(split.held.run.tolist()) if name in floor]
    squares = [np.mean(error[split.held.run == name] ** 2) / floor[name] ** 2 for name in names]
    return float(np.sqrt(np.mean(squares)))


def outcome(peer: Peer, by_channel: Mapping[str, Split], floor: Mapping[str, Mapping[str, float]]) -> Outcome:
    """Fit and predict every channel; the worst channel before stays the one that is judged."""
    began, before, after, families = time.process_time(), {}, {}, set()
    for channel, split in by_channel.items():
        guess = peer.guess(split, channel)
        before[channel] = over_floor(split.held.y, split, floor[channel])
        after[channel] = over_floor(split.held.y - guess.y, split, floor[channel])
        families |= guess.families
    worst = max(before, key=lambda channel: before[channel])
    return Outcome(before[worst], after[worst], len(families), time.process_time() - began)


def compare(suite: Path, limit: int) -> dict[str, list[Outcome]]:
    """Every peer on the first `limit` cases with something in the library hidden and a torque sensor."""
    methods = peers()
    out: dict[str, list[Outcome]] = {peer.name: [] for peer in methods}
    for truth_file in sorted((suite / "truth").glob("case-*.json")):
        truth = json.loads(truth_file.read_text(encoding="utf-8"))
        fair = truth["kind"] in KINDS and truth["plan"] in ("complete", "one_direction") and truth["size"] >= 1.5
        if not fair or len(out[methods[0].name]) >= limit:
            continue
        by_channel = splits(suite / truth_file.stem, suite / "traces" / truth_file.name)
        for peer in methods:
            out[peer.name].append(outcome(peer, by_channel, truth["floor"]))
        print(f"{truth_file.stem} done", file=sys.stderr, flush=True)
    return out


def line(name: str, outcomes: list[Outcome]) -> str:
    after = np.array([o.after for o in outcomes])
    median, high = np.median(after), np.percentile(after, 90)
    worse = sum(o.after > 1.02 * o.before for o in outcomes)
    named = f"{np.median([o.families for o in outcomes]):.0f}"
    good = f"{np.sum(after <= 1.3)} of {len(after)}"
    seconds = f"{np.median([o.seconds for o in outcomes]):.0f} s"
    return f"| {name} | {median:.2f} | {high:.2f} | {good} | {worse} | {named} | {seconds} |"


def table(results: Mapping[str, list[Outcome]]) -> str:
    """Markdown, one line a method, worst channel of each case."""
    some = next(iter(results.values()))
    before = np.array([o.before for o in some])
    head = [
        "## Peers: held-out error over floor, most affected channel", "",
        f"{len(some)} cases worth a name; floor = residual of the same runs without the effect. The baseline alone: "
        f"median {np.median(before):.2f}, 90 % below {np.percentile(before, 90):.2f}.", "",
        "| method | median | 90 % below | ≤ 1.3 | worse than nothing | families named (median) | CPU time per case |",
        "|---|---|---|---|---|---|---|",
    ]  # fmt: skip
    return "\n".join([*head, *(line(name, outcomes) for name, outcomes in results.items())]) + "\n"


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="tests.blind.peers.compare", description=__doc__)
    parser.add_argument("suite", type=Path)
    parser.add_argument("--cases", type=int, default=20, help="at most this many cases")
    parser.add_argument("--table", type=Path, help="append the table to this file")
    options = parser.parse_args(arguments)
    try:
        results = compare(options.suite, options.cases)
    except ImportError as absent:
        print(f"peers left out: {absent.name} is not installed (pip install 'hdrig[peers]')", file=sys.stderr)
        return 0
    page = table(results)
    print(page)
    if options.table:
        with options.table.open("a", encoding="utf-8") as file:
            file.write("\n" + page)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
