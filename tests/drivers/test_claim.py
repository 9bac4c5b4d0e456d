"""One program at a time at a bench: the second is told who the first is, and what is killed is in nobody's way."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from drivers import claim
from drivers.bus import Bus
from drivers.claim import Claim, claim_port, connect_alone
from drivers.port import Port
from rig.core.clock import WallClock
from rig.core.errors import NotReady

OTHER = """
import sys, time
from pathlib import Path
from drivers import claim
claim.FOLDERS = (Path(sys.argv[1]),)
held = claim.Claim(sys.argv[2])
print("held", flush=True)
time.sleep(60)
"""


@pytest.fixture(autouse=True)
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(claim, "FOLDERS", (tmp_path,))


@pytest.fixture
def other(tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """Another process that holds 'CAN socketcan can0'."""
    script = tmp_path / "elsewhere.py"
    script.write_text(OTHER)
    process = subprocess.Popen(
        [sys.executable, script, tmp_path, "CAN socketcan can0"], stdout=subprocess.PIPE, text=True,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )  # fmt: skip
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    yield process
    process.kill()
    process.wait()
    process.stdout.close()


@pytest.mark.slow
def test_the_second_is_told_which_process_the_first_is(other: subprocess.Popen[str]) -> None:
    with pytest.raises(NotReady, match=rf"can0 is in use by process {other.pid} \(elsewhere.py .*\), since .* UTC"):
        Claim("CAN socketcan can0")
    Claim("CAN socketcan can1").release()  # another channel is another bench
    bus = Bus("rig", "socketcan", "can0", WallClock(), {})
    with pytest.raises(NotReady, match=rf"bus 'rig' \(socketcan can0\) could not be opened: .* process {other.pid}"):
        bus.open()


@pytest.mark.slow
def test_what_was_killed_is_in_nobodys_way(other: subprocess.Popen[str], tmp_path: Path) -> None:
    other.send_signal(signal.SIGKILL)
    other.wait()
    held = Claim("CAN socketcan can0")
    assert f"process {os.getpid()} " in next(tmp_path.glob("hdrig-*.lock")).read_text()
    held.release()


def test_what_was_let_go_can_be_taken_again_and_letting_go_twice_is_no_fault() -> None:
    first = Claim("CAN slcan a")
    with pytest.raises(NotReady, match="in use"):
        Claim("CAN slcan a")
    first.release()
    first.release()
    Claim("CAN slcan a").release()


def test_a_bus_that_cannot_be_opened_is_not_kept_from_others(tmp_path: Path) -> None:
    for _ in range(2):
        with pytest.raises(can.CanInitializationError, match="no CAN bus at"):
            connect_alone("hdrig-unix", str(tmp_path / "nobody"))


def test_a_port_that_cannot_be_opened_is_not_kept_from_others(tmp_path: Path) -> None:
    for _ in range(2):
        with pytest.raises(NotReady, match="could not be opened"):
            Port(str(tmp_path / "ttyUSB7"), 9600, "torque sensor").open()


def test_a_link_to_a_port_is_that_port(tmp_path: Path) -> None:
    (tmp_path / "by-id").symlink_to("/dev/null")
    held = claim_port("/dev/null")
    with pytest.raises(NotReady, match="/dev/null is in use"):
        claim_port(str(tmp_path / "by-id"))
    held.release()


def test_a_link_in_place_of_the_lock_file_is_not_followed(tmp_path: Path) -> None:
    target = tmp_path / "precious"
    target.write_text("kept")
    (tmp_path / "hdrig-CAN-a-b.lock").symlink_to(target)
    with pytest.raises(NotReady, match="cannot be opened: without it two programs could command one bench"):
        Claim("CAN a b")
    assert target.read_text() == "kept"


def test_a_bus_within_the_process_needs_no_claim(tmp_path: Path) -> None:
    both = [connect_alone("virtual", "here") for _ in range(2)]
    for bus in both:
        bus.shutdown()
    assert not list(tmp_path.glob("*.lock"))
