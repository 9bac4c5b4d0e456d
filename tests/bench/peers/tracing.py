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


def seconds(method: str, campaign: Path) -> float:
    """CPU time [s] to predict what the baseline leaves, in every channel."""
    began = time.process_time()
    for channel, split in data.splits(campaign, campaign / "none.json").items():
        METHODS[method]().guess(split, channel)
    return time.process_time() - began


if __name__ == "__main__":
    for line in sys.stdin:
        question = json.loads(line)
        print(json.dumps({"cpu": seconds(question["method"], Path(question["campaign"]))}), flush=True)
