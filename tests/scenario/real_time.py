"""By hand: `python -m tests.scenario.real_time` makes every procedure and sweep by name over `hdrig twin`, shortened.

Real time, every byte: the twin in one process, `hdrig run … --bench twin-can.toml` in another, as an operator types it.
A line of a table each: exit code, what became of its runs, the figure. A shared machine stalls for tens of ms: a run
that the guard ends for that alone is made again.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rig.campaign.sweeps import CATALOGUE as SWEEPS
from rig.procedures import CATALOGUE as PROCEDURES
from tests.contract.test_procedures import SHORTER
from tests.scenario.test_over_the_wire import HDRIG, STALLED, Twin

NAMES = (*PROCEDURES, *SWEEPS)
SHORT: dict[str, dict[str, Any]] = SHORTER | {
    "kinematic-error": {"amplitude_deg": 720.0, "frequency": 0.04, "cycles": 1.0},
    "skew": {"speeds_rpm": "60,120", "repeats": 2},
    "speed-convergence": {"amplitude_deg": 360.0, "speeds_rpm": "120,80,60", "least": 4.0},
    "coast-down": {"repeats": 2, "speed_rpm": 200.0},
    "load-sweep": {"weights": (0.0, 3.0), "amplitude_deg": 360.0, "frequency": 0.05},
    "assembly-sweep": {"depths_mm": (0.15,), "reference": 2, "weights": (0.0,), "amplitude_deg": 360.0,
                       "frequency": 0.05},
    "identify": {"speeds_rpm": (120.0, 200.0), "cycles": 0.5, "revolutions": 15, "lock_cycles": 1,
                 "friction_rpm": "60,120,200", "lock_rate": 5.0},
}  # fmt: skip
PATIENT = ("--set", "limits.stale_s=0.6", "--set", "devices.drive.watchdog=0.7")  # a busy machine is not the subject
APART = "motor and load disagree by"  # at 14 °/s a load angle that is 30 ms late looks like a gear wound up by 0.43°
TRIES = 4
LONGEST = 900.0  # s


@dataclass(frozen=True)
class Outcome:
    """What became of one `hdrig run`."""

    name: str
    exit: int
    status: dict[str, int]  # of the runs of experiments among its folders, how many are in which
    sentence: str
    seconds: float
    tries: int
    said: str  # all of stdout and stderr


@contextmanager
def twin_at(doors: Path, seconds: float) -> Iterator[Twin]:
    """A twin whose doors are in `doors`, as twin-can.toml wants it."""
    options = ["--bus", "can", "--control", "control", "--serial", "serial", "--for", str(seconds)]
    process = subprocess.Popen([*HDRIG, "twin", *options], cwd=doors, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    for line in process.stdout:
        if line == "ready\n":
            break
    (doors / "port").write_text("0")
    try:
        yield Twin(doors, process)
    finally:
        process.terminate()
        process.wait(10)
        process.stdout.close()


def by_name(twin: Twin, name: str, root: Path) -> Outcome:
    """`hdrig run NAME`, its runs into a folder of their own in `root`; made again where the machine was away."""
    given = [f"--with={key}={toml(value)}" for key, value in SHORT.get(name, {}).items()]
    began, tries = time.monotonic(), 0
    while True:
        out, tries = root / f"{name}-{tries + 1}", tries + 1
        twin.ask(do="unlock")  # whatever the one before left behind
        twin.ask(do="load", tau_ext=0.0)
        command = [*HDRIG, "run", name, "--bench", str(twin.bench("twin-can")), "--out", str(out), *given, *PATIENT]
        done = subprocess.run(command, capture_output=True, text=True, timeout=LONGEST, check=False)
        said = done.stdout + done.stderr
        if tries == TRIES or not (STALLED.search(said) or APART in said):
            break
    return Outcome(name, done.returncode, statuses(out), sentence(done.stdout), time.monotonic() - began, tries, said)


def statuses(out: Path) -> dict[str, int]:
    """Of every run folder below `out` that came over the wire from a twin."""
    found: dict[str, int] = {}
    for path in out.rglob("manifest.json"):
        manifest = json.loads(path.read_text(encoding="utf-8"))
        assert (manifest["backend"], manifest["transport"]) == ("sim", "can"), path
        found[manifest["status"]] = found.get(manifest["status"], 0) + 1
    return found


def sentence(stdout: str) -> str:
    """The main figure: the line below the run's name, the summary's head, or whatever comes first."""
    lines = [line for line in stdout.splitlines() if line and not re.match(r"SIMULATED \S+$", line)]
    return lines[0][:110] if lines else ""


def toml(value: object) -> str:
    """As --with takes it."""
    return json.dumps(list(value) if isinstance(value, tuple) else value)


def main(names: list[str]) -> None:
    """All, or those named."""
    print("| procedure | exit | runs | tries | s | said |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(dir="/tmp") as folder, twin_at(Path(folder), 3600.0) as twin:
        for name in names or NAMES:
            o = by_name(twin, name, Path(folder) / "runs")
            runs = ", ".join(f"{n} {status}" for status, n in o.status.items())
            print(f"| {name} | {o.exit} | {runs} | {o.tries} | {o.seconds:.0f} | {o.sentence} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
