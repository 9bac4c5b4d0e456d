"""`hdrig serve` and `hdrig twin` as an operator starts them: two processes, a CAN bus between them, real time."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rig.bench import BENCHES

HDRIG = [sys.executable, "-m", "rig.cli"]
ENDING = 20.0  # s to bring a motor to rest and close a run
PATIENT = (("stale_s", 0.1, 0.6), ("watchdog", 0.15, 0.8))  # s: a browser beside it stalls a machine of two processors
QUIET = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}


@dataclass(frozen=True)
class Rig:
    """A console, and the twin it reaches over CAN."""

    url: str
    root: Path  # of its runs
    doors: Path  # of the twin
    server: subprocess.Popen[str]
    twin: subprocess.Popen[str]

    @property
    def bus(self) -> str:
        """The twin's CAN bus, for one who listens."""
        return str(self.doors / "can")

    def ask(self, **verb: object) -> dict[str, Any]:
        """The twin's command channel."""
        with socket.socket(socket.AF_UNIX) as line:
            line.connect(str(self.doors / "control"))
            line.sendall(json.dumps(verb).encode() + b"\n")
            answer: dict[str, Any] = json.loads(line.makefile().readline())
        return answer

    def manifests(self) -> list[dict[str, Any]]:
        """Of every run, in order of their start."""
        found = [json.loads(path.read_text(encoding="utf-8")) for path in self.root.glob("[!.]*/*/manifest.json")]
        return sorted(found, key=lambda manifest: str(manifest["started_utc"]))

    def closed(self, runs: int) -> list[dict[str, Any]]:
        """Manifests of that many runs, waited for until the last of them is closed."""
        end = time.monotonic() + ENDING
        while True:
            found = self.manifests()
            if len(found) >= runs and all(one["status"] != "running" for one in found):
                return found
            assert time.monotonic() < end, [one["status"] for one in found]
            time.sleep(0.1)


@contextmanager
def rig() -> Iterator[Rig]:
    """Both processes, ended by their ids."""
    with tempfile.TemporaryDirectory(prefix="hdrig-", dir="/tmp") as folder:  # a socket's path is 107 characters long
        doors, root = Path(folder), Path(folder) / "runs"
        bench = doors / "can-rig.toml"
        bench.write_text(_patient((BENCHES / "twin-can.toml").read_text(encoding="utf-8"), folder), encoding="utf-8")
        options = ["--bus", "can", "--control", "control", "--serial", "serial", "--for", "600"]
        twin = _started([*HDRIG, "twin", *options], doors, "ready")[0]
        server, line = _started(
            [*HDRIG, "serve", "--port", "0", "--bench", str(bench), "--out", str(root)], doors, "console "
        )
        try:
            yield Rig(line.split()[1], root, doors, server, twin)
        finally:
            for process in (server, twin):
                _ended(process)


def _patient(shipped: str, folder: str) -> str:
    """The shipped bench, led to the doors in `folder`, with time for a machine that stalls."""
    ours = shipped.replace("/tmp/hdrig-twin", folder).replace('"twin-can"', '"can-rig"')
    for name, before, patient in PATIENT:
        assert f"{name} = {{ value = {before}," in ours
        ours = ours.replace(f"{name} = {{ value = {before},", f"{name} = {{ value = {patient},")
    return ours


def _started(command: list[str], folder: Path, ready: str) -> tuple[subprocess.Popen[str], str]:
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True, env=QUIET)
    assert process.stdout is not None
    for line in process.stdout:
        if line.startswith(ready):
            return process, line
    raise AssertionError(f"{command} ended before it was ready")


def _ended(process: subprocess.Popen[str]) -> None:
    if process.poll() is None:
        process.send_signal(signal.SIGINT)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(ENDING)
    if process.poll() is None:
        process.kill()
        process.wait(ENDING)
    if process.stdout is not None:
        process.stdout.close()
