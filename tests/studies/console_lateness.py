"""How late the loop is with the console and without: python -m tests.studies.console_lateness [--rounds 5].

They take turns, so that what else the machine does falls on all: `hdrig run` in a process of its own, and the same run
behind `hdrig serve` with pages that listen. The twin at 1 kHz on the wall clock, standing still. Figures are those the
loop itself counts, every tick; what is asserted are counts.
"""

from __future__ import annotations

import argparse
import json
import signal
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from tests.console.client import Client

HDRIG = [sys.executable, "-m", "rig.cli"]
SECONDS = 10.0  # s of each run


def alone(root: Path) -> dict[str, Any]:
    """timing.json of a run from the command line."""
    command = ["run", "standstill", "--clock", "wall", "--with", f"duration={SECONDS}", "--out", str(root)]
    subprocess.run([*HDRIG, *command], check=True, capture_output=True)
    return timing(newest(root))


def served(root: Path, pages: int) -> dict[str, Any]:
    """timing.json of a run from the console, `pages` pages listening to states and samples."""
    server = subprocess.Popen([*HDRIG, "serve", "--port", "0", "--out", str(root)], stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    try:
        url = server.stdout.readline().split()[1]
        clients = [Client(url) for _ in range(pages)]
        clients[0].finish("connect", bench="twin")
        clients[0].start("standstill", duration=SECONDS)
        clients[0].until(lambda state: not state["job"])
        assert all(client.frames > 10 * SECONDS for client in clients), "a page did not get its samples"
    finally:
        server.send_signal(signal.SIGINT)
        server.communicate()
    return timing(newest(root))


def newest(root: Path) -> Path:
    """The folder of the only run below `root`."""
    (found,) = root.glob("*/*/manifest.json")
    return found.parent


def timing(folder: Path) -> dict[str, Any]:
    """What the loop counted."""
    said: dict[str, Any] = json.loads((folder / "timing.json").read_text())
    assert said["ticks"] + said["missed_cycles"] >= 0.99 * SECONDS / said["period"]
    return said


def line(name: str, said: list[dict[str, Any]]) -> str:
    """Medians over the rounds."""
    p50, p99, p999 = (statistics.median(s[f"lateness_{q}"] for s in said) * 1e6 for q in ("p50", "p99", "p999"))
    missed = [100 * s["missed_cycles"] / (s["ticks"] + s["missed_cycles"]) for s in said]
    each = " ".join(f"{m:.2f}" for m in missed)
    return f"{name:24s} p50 {p50:6.0f} µs  p99 {p99:7.0f} µs  p99.9 {p999:8.0f} µs  missed {each} %"


def main() -> None:
    """Print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    found: dict[str, list[dict[str, Any]]] = {"hdrig run": [], "console, one page": [], "console, four pages": []}
    for _ in range(rounds):
        for name, pages in zip(found, (0, 1, 4), strict=True):
            with tempfile.TemporaryDirectory() as folder:
                found[name].append(served(Path(folder), pages) if pages else alone(Path(folder)))
    print(f"{rounds} rounds of {SECONDS:g} s at 1 kHz, the conditions in turn; {found['hdrig run'][0]['scheduling']}")
    for name, said in found.items():
        print(line(name, said))


if __name__ == "__main__":
    main()
