"""Peers of the tracer on one campaign: CPU time of each method, reading and splitting included."""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

from tests.blind.peers import data
from tests.blind.peers.black_box import Boosting, Gaussian
from tests.blind.peers.peer import Peer
from tests.blind.peers.sparse import SparsePhysical

METHODS: dict[str, type[Peer]] = {"boosting": Boosting, "gaussian": Gaussian, "pysindy": SparsePhysical}
data.ROWS_PER_RUN = 10**9  # every row, where the blind test offers 400 of each run: the same evidence


def seconds(method: str, campaign: Path, trace: Path) -> float:
    """CPU time [s], with the split of `trace`, to predict what the baseline leaves, in every channel."""
    began = time.process_time()
    for channel, split in data.splits(campaign, trace).items():
        METHODS[method]().guess(split, channel)
    return time.process_time() - began


if __name__ == "__main__":
    for line in sys.stdin:
        question = json.loads(line)
        cpu = seconds(question["method"], Path(question["campaign"]), Path(question["trace"]))
        print(json.dumps({"cpu": cpu}), flush=True)
