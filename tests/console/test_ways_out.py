"""`hdrig serve` and its control process as processes: Ctrl-C, kill -9 of either, a page that is lost, in mid-run.

In real time. What is looked at are folders and their words, never how long anything took.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.runfile.manifest import read
from tests.console.client import PATIENCE, Client, until
from tests.console.hand import FOREVER

pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("real time")]
FAR = ["limits.stale_s=0.5", "twin.watchdog=1.0"]  # a loaded machine's twin may be late: that is not what is tried here
AWAY = 3.0  # s a page may be away: its signs of life come from this process, which may be late as well


class Served(Client):
    """`hdrig serve` as somebody starts it, with a page."""

    def __init__(self, root: Path) -> None:
        command = [sys.executable, "-m", "rig.cli", "serve", "--port", "0", "--out", str(root)]
        self.said = root / "terminal.txt"  # what it has to say beside its address
        with self.said.open("w") as terminal:
            self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=terminal, text=True)
        assert self.process.stdout is not None
        super().__init__(self.process.stdout.readline().split()[1])

    def running(self, page_lost: str = "continue", procedure: str = "standstill", **parameters: float) -> Path:
        """The folder of a run that goes on and on, half a second into it; standing still, unless told otherwise."""
        overrides = [f"console.page_lost={page_lost}", f"console.page_lost_s={AWAY}", *FAR]
        self.finish("connect", bench="twin", overrides=overrides)
        return self.start(procedure, **(parameters or {"duration": 1000.0}))

    @property
    def station(self) -> int:
        """The control process: the server's only child with that name."""
        found = subprocess.run(
            ["pgrep", "-P", str(self.process.pid), "-f", "rig.station"], capture_output=True, text=True
        )
        return int(found.stdout.split()[0])


def gone(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return True
    return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Served]:
    made = Served(tmp_path)
    yield made
    made.process.kill()
    made.process.communicate()
    made.close()


def test_a_killed_server_is_a_lost_page_and_the_run_is_stopped_and_closed(served: Served) -> None:
    folder, station = served.running("stop"), served.station
    served.process.kill()
    until(lambda: gone(station), bool)
    about = read(folder)
    assert about["status"] == "stopped"
    assert "because no page had been seen for 3 s, as [console] page_lost says" in about["exit_reason"]


@pytest.mark.long
def test_a_killed_server_leaves_a_run_to_go_on_where_the_bench_says_so(served: Served) -> None:
    folder, station = served.running("continue"), served.station
    served.process.kill()
    served.process.wait()
    rows = int((folder / "manifest.json").stat().st_mtime_ns)
    time.sleep(2.0 * AWAY)
    assert read(folder)["status"] == "running"
    assert not gone(station)
    assert (folder / "manifest.json").stat().st_mtime_ns == rows
    os.kill(station, signal.SIGTERM)  # what is left to somebody without a page: brought to rest, closed
    until(lambda: gone(station), bool)
    assert read(folder)["status"] == "stopped"


@pytest.mark.long
def test_a_page_that_is_closed_stops_the_run_while_the_server_lives(served: Served) -> None:
    folder = served.running("stop")
    served.leave()
    state = served.until(lambda s: not s["job"])
    assert "because no page had been seen" in state["last_run"]["reason"]
    assert read(folder)["status"] == "stopped"


def test_ctrl_c_brings_the_motor_to_rest_and_closes_the_run_before_the_server_ends(served: Served) -> None:
    folder = served.running(procedure="kinematic-error", **FOREVER)
    station = served.station
    served.process.send_signal(signal.SIGINT)
    assert served.process.wait(PATIENCE) == 0
    (line,) = served.said.read_text().splitlines()  # the control process ended because it was told to
    assert line.startswith("hdrig: the kinematic-error run has ended: stopped by the operator: ")
    assert line.endswith(f"brought to rest, torque off; its folder is {folder}")
    assert gone(station)
    about = read(folder)
    assert (about["status"], "brought to rest" in about["exit_reason"]) == ("stopped", True)


@pytest.mark.long
def test_ctrl_c_twice_takes_the_torque_off_at_once(served: Served) -> None:
    folder = served.running()
    served.process.send_signal(signal.SIGINT)
    served.process.send_signal(signal.SIGINT)
    assert served.process.wait(PATIENCE) == 0
    assert read(folder)["status"] == "stopped"


@pytest.mark.long
def test_ctrl_backslash_takes_the_torque_off_at_once_and_closes_the_run(served: Served) -> None:
    folder = served.running()
    served.process.send_signal(signal.SIGQUIT)
    assert served.process.wait(PATIENCE) == 0
    about = read(folder)
    assert (about["status"], "halted" in about["exit_reason"]) == ("stopped", True)


def test_a_killed_control_process_is_told_and_its_run_can_be_recovered(served: Served) -> None:
    folder, station = served.running(), served.station
    os.kill(station, signal.SIGKILL)
    state = served.until(lambda s: not s["station"])
    (line,) = served.said.read_text().splitlines()
    assert line.startswith(f"hdrig: the control process {station} has ended by signal SIGKILL: nobody looks after")
    assert "nobody confirms that its torque is off. Use the hard-wired stop." in line
    assert line.endswith(f"hdrig recover {folder}")
    assert "the control process has ended" in state["fault"]
    assert "Use the hard-wired stop." in state["advice"]
    assert f"hdrig recover {folder}" in state["advice"]
    assert (state["run"], state["bench"]["simulated"]) == (None, True)
    for act in ("halt", "stop", "hold"):  # nobody hears them, and nobody is told that somebody did
        asked = {"id": str(uuid.uuid4()), "act": act, "based_on": state["revision"]}
        said = served.client.post("/api/act", json=asked)
        assert (said.status_code, said.json()["accepted"]) == (409, False)
        assert "Use the hard-wired stop" in said.json()["why"]
    recovered = subprocess.run(
        [sys.executable, "-m", "rig.cli", "recover", str(folder)], capture_output=True, text=True
    )
    until(lambda: read(folder)["status"], lambda status: status == "interrupted")
    assert recovered.returncode in (0, 3)  # 3: its recorder, which outlives it, was still writing


def test_a_port_that_is_taken_is_a_sentence(served: Served) -> None:
    port = str(served.client.base_url.port)
    said = subprocess.run([sys.executable, "-m", "rig.cli", "serve", "--port", port], capture_output=True, text=True)
    assert said.returncode == 3
    assert f"nothing can listen at 127.0.0.1, port {port}" in said.stderr


@pytest.mark.long
def test_an_address_that_others_reach_says_where_tls_ends(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "rig.cli", "serve", "--host", "0.0.0.0", "--port", "0", "--out", str(tmp_path)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    lines = [process.stdout.readline() for _ in range(2)]
    process.send_signal(signal.SIGTERM)
    process.communicate(timeout=PATIENCE)
    assert "#token=" in lines[0]
    assert "reverse proxy" in lines[1]
    assert "ssh -L" in lines[1]
