"""By hand: `python -m tests.scenario.real_time` runs every procedure of the catalogue over `hdrig twin` in real time.

A line each: how it ended, rows, cycles missed. A shared machine stalls: a run the guard ends for that says so.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace

from rig.bench import BENCHES, Bench
from rig.config import read_bench
from rig.core.clock import WallClock
from rig.core.errors import HdrigError
from rig.procedures import CATALOGUE
from rig.timing import LoopTiming
from tests.contract.test_procedures import made
from tests.drivers.running import run
from tests.scenario.test_over_the_wire import HDRIG, Twin


def begin(doors: Path) -> Twin:
    """A twin whose doors are in `doors`."""
    options = ["--bus", "can", "--control", "control", "--for", "1800"]
    process = subprocess.Popen([*HDRIG, "twin", *options], cwd=doors, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    for line in process.stdout:
        if line == "ready\n":
            break
    return Twin(doors, process)


def one(twin: Twin, name: str) -> str:
    """Connect, run, close; what came of it."""
    text = (BENCHES / "twin-canopen.toml").read_text(encoding="utf-8").replace("/tmp/hdrig-twin", str(twin.doors))
    bench, procedure = Bench(read_bench(text, name), text, name), made(name)
    twin.ask(do="lock" if procedure.output_locked else "unlock")
    instruments = bench.wired(WallClock())
    timing = LoopTiming(1e-3, virtual=False)
    began = time.monotonic()
    try:
        instruments.connect()
        ending, sink = run(SimpleNamespace(bench=bench, instruments=instruments), procedure, timing=timing)
        told = f"{ending.status}, {len(sink.rows)} rows" + (
            "" if ending.status == "completed" else f": {ending.reason}"
        )
    except HdrigError as why:
        told = f"refused: {why}"
    finally:
        instruments.close()
        time.sleep(1.0)  # s: what turned comes to rest
    return f"{told}; {timing.missed} of {timing.ticks + timing.missed} cycles missed, {time.monotonic() - began:.0f} s"


def main(names: list[str]) -> None:
    """All, or those named."""
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        twin = begin(Path(folder))
        try:
            for name in names or list(CATALOGUE):
                print(f"{name:20s} {one(twin, name)}", flush=True)
        finally:
            twin.process.terminate()
            twin.process.wait(10)


if __name__ == "__main__":
    main(sys.argv[1:])
