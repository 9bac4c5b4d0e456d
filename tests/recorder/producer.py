"""A program that makes a run until somebody kills it, or its recorder: `python -m tests.recorder.producer ROOT`.

Prints folder, ring and the recorder's pid; and, when it could end by itself, how many rows were kept.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from rig.core.errors import RecorderError
from rig.core.ring import Ring
from rig.recorder import Recorder
from rig.runfile.process import this_process
from tests.recorder.clocks import WallClock
from tests.runfile.rows import new_folder, sample

RATE = 20_000  # rows/s: twenty times the loop's, so that little time shows much


def main(root: Path) -> None:
    """Put rows on time, whatever the recorder does, until it is dead."""
    folder = new_folder(root, process=this_process())
    recorder = Recorder(folder, WallClock())
    recorder.start()
    ring = Ring.attach(recorder.ring)
    print(folder, recorder.ring, ring.reader[0], flush=True)
    began, rows = time.monotonic(), 0
    while True:
        while rows < (time.monotonic() - began) * RATE:
            recorder.put(*sample(rows))
            rows += 1
        try:
            recorder.check()
        except RecorderError:
            break
        time.sleep(0.001)
    kept = recorder.close()
    print(rows, kept, flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
