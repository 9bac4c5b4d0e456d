"""How late the loop is with a terminal and without: python -m tests.studies.terminal_lateness [--rounds 5].

They take turns, so that what else the machine does falls on all: nothing shown at all, `hdrig run` on a terminal with
its keys listened to, `hdrig run --json` into a file, and a terminal that was stopped with Ctrl-S. The twin at 1 kHz on
the wall clock, standing still. Figures are those the loop itself counts, every tick.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.commands.show.terminals import Terminal
from tests.studies.console_lateness import SECONDS, line, newest, timing

NOTHING = """
import sys
from pathlib import Path
from rig.bench import read
from rig.process.interrupts import Interrupts
from rig.procedures.standstill import Standstill
from rig.session import Session
with Interrupts() as interrupts, Session(read("twin"), "wall", Path(sys.argv[1]), interrupts) as session:
    session.run(Standstill(float(sys.argv[2])))
"""


def arguments(root: Path) -> list[str]:
    """The same run for all."""
    return ["run", "standstill", "--clock", "wall", "--with", f"duration={SECONDS}", "--out", str(root)]


def nothing(root: Path) -> None:
    """Nobody looks on."""
    subprocess.run([sys.executable, "-c", NOTHING, str(root), str(SECONDS)], check=True, capture_output=True)


def terminal(root: Path) -> None:
    """Two lines drawn ten times a second."""
    shown = Terminal(arguments(root))
    try:
        shown.end()
        assert "RUNNING standstill" in shown.seen
    finally:
        shown.close()


def json_lines(root: Path) -> None:
    """Every event into a file."""
    shown = Terminal([*arguments(root), "--json"], json=root / "events.jsonl")
    try:
        shown.end()
    finally:
        shown.close()


def stopped(root: Path) -> None:
    """A terminal that takes nothing for the second half of the run."""
    shown = Terminal(arguments(root))
    try:
        shown.wait_for(lambda seen: "RUNNING standstill" in seen)
        shown.press("\x13")
        time.sleep(SECONDS)
        shown.press("\x11")
        shown.end()
    finally:
        shown.close()


def main() -> None:
    """Print a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    ways: dict[str, Callable[[Path], None]] = {
        "nothing shown": nothing, "terminal and keys": terminal, "--json": json_lines, "terminal stopped": stopped,
    }  # fmt: skip
    found: dict[str, list[dict[str, Any]]] = {name: [] for name in ways}
    for _ in range(rounds):
        for name, way in ways.items():
            with tempfile.TemporaryDirectory() as folder:
                way(Path(folder))
                found[name].append(timing(newest(Path(folder))))
    print(
        f"{rounds} rounds of {SECONDS:g} s at 1 kHz, the conditions in turn; {found['nothing shown'][0]['scheduling']}"
    )
    for name, said in found.items():
        print(line(name, said))


if __name__ == "__main__":
    main()
