"""The process between ring and viewer: viewers that are killed, frozen, closed."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from rig.core.ring import Ring
from rig.live.view.__main__ import NICE
from rig.live.view.bridge import CHECK, Bridge, Commands
from rig.live.view.server import Proxy
from rig.live.view.viewer import Viewer
from rig.runfile.process import started
from tests.live.view.test_feed import put, say

pytestmark = pytest.mark.slow


class Rig:
    """A ring that is filled, a bridge that follows it, on a clock that is set."""

    def __init__(self, folder: Path) -> None:
        self.now, self.rows = 0.0, 0
        self.ring = Ring.create(4096)
        say(folder, ring=str(self.ring.path))
        self.server = Proxy()
        self.server.start()
        self.bridge = Bridge(self.server, lambda: self.now)
        self.bridge.follow(folder)

    def beats(self, count: int, rows: int = 500) -> None:
        """`count` beats, a look at the viewer with each."""
        for _ in range(count):
            put(self.ring, range(self.rows, self.rows + rows))
            self.rows += rows
            self.now += CHECK
            self.bridge.beat()


@pytest.fixture
def rig(tmp_path: Path) -> Iterator[Rig]:
    rig = Rig(tmp_path)
    yield rig
    rig.server.stop()
    rig.ring.unlink()


def test_a_viewer_that_was_killed_is_there_again_on_its_port_and_is_sent_what_comes(rig: Rig) -> None:
    rig.beats(3)
    before, port = rig.server.pid, rig.server.port
    os.kill(before, signal.SIGKILL)
    os.waitid(os.P_PID, before, os.WEXITED | os.WNOWAIT)
    rig.beats(3)
    assert rig.server.runs
    assert (rig.server.pid != before, rig.server.port) == (True, port)
    assert rig.bridge.heard
    assert rig.bridge.skipped == 0


def test_a_frozen_viewer_is_sent_nothing_more_and_everything_again_once_it_thaws(rig: Rig) -> None:
    rig.beats(3)
    os.kill(rig.server.pid, signal.SIGSTOP)
    tries = 0
    while rig.bridge.heard and tries < 400:  # what fits into the sockets is still taken
        rig.beats(1)
        tries += 1
    assert not rig.bridge.heard
    rig.beats(20)
    assert not rig.bridge.heard
    assert rig.bridge.skipped == 0  # the ring was read all the same
    os.kill(rig.server.pid, signal.SIGCONT)
    tries = 0
    while not rig.bridge.heard and tries < 400:
        rig.beats(1, rows=5)
        tries += 1
    assert rig.bridge.heard


def test_only_whole_lines_that_name_a_folder_are_commands() -> None:
    reads, writes = os.pipe()
    commands = Commands(reads)
    os.write(writes, b'{"follow": "/a"}\nnonsense\n{"follow": 3}\n{"fol')
    assert commands.wait(0.0) == ["/a"]
    os.write(writes, b'low": "/b"}\n')
    assert commands.wait(0.0) == ["/b"]
    assert commands.wait(0.0) == []
    os.close(writes)
    commands.wait(0.0)
    assert commands.closed
    os.close(reads)


@pytest.mark.parametrize("frozen", [[], ["bridge"], ["viewer"], ["bridge", "viewer"]])
def test_closing_leaves_nothing_behind_frozen_or_not(frozen: list[str], tmp_path: Path) -> None:
    viewer = Viewer("web")
    pids = {"bridge": viewer.pid, "viewer": viewer.viewer_pid}
    assert viewer.url.startswith("http://127.0.0.1:")
    viewer.follow(tmp_path)
    for name in frozen:
        os.kill(pids[name], signal.SIGSTOP)
    viewer.close()
    assert not viewer.runs
    for _ in range(200):  # the kernel's word reaches a child after its parent is gone
        if started(pids["viewer"]) == 0:
            break
        time.sleep(0.01)
    assert started(pids["viewer"]) == 0


def test_a_view_that_is_ready_stands_back_with_every_thread(tmp_path: Path) -> None:
    with Viewer("web") as viewer:
        for pid in (viewer.pid, viewer.viewer_pid):
            threads = [int(task.name) for task in Path(f"/proc/{pid}/task").iterdir()]
            assert {os.getpriority(os.PRIO_PROCESS, thread) for thread in threads} == {NICE}


def test_telling_a_frozen_bridge_more_than_it_can_take_waits_for_nobody(tmp_path: Path) -> None:
    with Viewer("web") as viewer:
        os.kill(viewer.pid, signal.SIGSTOP)
        for _ in range(5000):  # a pipe holds 64 kB
            viewer.follow(tmp_path)
        assert viewer.runs
