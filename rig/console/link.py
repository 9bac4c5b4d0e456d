"""The web process's end of the line to the station: starts it, keeps its last picture, waits for its replies."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import socket
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, final

from rig.live.switches import Switches
from rig.station.channel import Channel
from rig.station.status import Status

EVENTS = 200  # the newest, for pages that come later
REPLY = 5.0  # s a station has to say yes or no: it does so within 0.1 s unless the machine stalls
LOOK = 0.001  # s between two looks whether the loop has seen a switch
SEEN = 0.25  # s after which nobody waits any longer for that
REAPED = 0.2  # s until a process whose line is gone has ended as well
STARTING = "starting the control process"
ALONE = "nobody looks after the rig, and nobody confirms that its torque is off"
GONE = f"the control process has ended: {ALONE}"
DEAF = f"nobody hears it: {GONE}. Use the hard-wired stop"


def ended_by(code: int | None) -> str:
    """How a process with that return code ended: " by signal SIGKILL"; "" where it is not known."""
    if code is None:
        return ""
    return f" by signal {signal.Signals(-code).name}" if code < 0 else f" with exit code {code}"


@final
class Link:
    """`start` before anything else; then `picture`, `events` and `idle` are the newest there is."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.switches = Switches.create()
        self.picture: dict[str, Any] = Status(job=STARTING).picture()  # until the station says better
        self.events: deque[dict[str, Any]] = deque(maxlen=EVENTS)
        self.idle: deque[dict[str, Any]] = deque(maxlen=40)  # readings nobody has fetched yet: two seconds
        self.heard = time.monotonic()  # s, when anything came
        self.what_now = ""  # once the station is gone: what to do, and what there is of its run
        self.changed: Callable[[], None] = lambda: None  # told of every new picture or event
        self.lost: Callable[[str], None] = lambda sentence: None  # told when the station ended unasked
        self._asked_to_end = False
        self._replies: dict[str, asyncio.Future[str]] = {}
        self._process: subprocess.Popen[bytes] | None = None
        self._channel: Channel | None = None

    def start(self) -> None:
        """Start the station and listen to it."""
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        command = [sys.executable, "-m", "rig.station", str(theirs.fileno()), str(self.switches.path), str(self.root)]
        with theirs:
            # a group of its own: a Ctrl-C is the server's, which asks the station to bring the motor to rest
            self._process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, pass_fds=[theirs.fileno()], process_group=0,
                env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            )  # fmt: skip
        self._channel = Channel(ours)
        asyncio.get_running_loop().add_reader(ours.fileno(), self._readable)

    @property
    def pid(self) -> int:
        """Of the station."""
        return self._process.pid if self._process else 0

    @property
    def alive(self) -> bool:
        """False once the station's end of the line is gone."""
        return self._channel is not None and not self._channel.closed

    def _readable(self) -> None:
        if self._channel is None:
            return
        for message in self._channel.receive():
            self._take(message)
        if self._channel.closed:
            asyncio.get_running_loop().remove_reader(self._channel.fileno())
            self._gone()

    def _take(self, message: Mapping[str, Any]) -> None:
        self.heard = time.monotonic()
        match message.get("kind"):
            case "status":
                self.picture = message["status"]
                self.changed()
            case "event":
                self.events.append(message["event"])
                self.changed()
            case "idle":
                self.idle.append(dict(message))
            case "reply":
                waiting = self._replies.pop(str(message.get("id")), None)
                if waiting is not None and not waiting.done():
                    waiting.set_result(str(message.get("why", "")))

    def _gone(self) -> None:
        self.what_now = self._advice()
        if not self._asked_to_end:
            self.lost(self._post_mortem())
        known = Status(bench=self.picture["bench"], state="fault", fault=GONE, last_run=self.picture["last_run"])
        self.picture = known.picture()
        for waiting in self._replies.values():
            if not waiting.done():
                waiting.set_result(GONE)
        self._replies.clear()
        self.changed()

    def _post_mortem(self) -> str:
        """What died, what that means, what to do; one line for whoever looks at the terminal."""
        assert self._process is not None
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(REAPED)
        how = ended_by(self._process.returncode)
        return f"the control process {self.pid} has ended{how}: {ALONE}. {self.what_now}"

    def _advice(self) -> str:
        """What to do, and how the run that died with the station is made readable, where one did."""
        run = self.picture["run"]
        rest = f"; then what there is of its run: hdrig recover {run['folder']}" if run is not None else ""
        return f"Use the hard-wired stop. Then end hdrig serve with Ctrl-C and start it again{rest}"

    async def act(self, message: Mapping[str, Any]) -> str:
        """Hand an act on; why the station refuses it, or ""."""
        if self._channel is None or not self.alive:
            return GONE
        waiting: asyncio.Future[str] = asyncio.get_running_loop().create_future()
        self._replies[str(message["id"])] = waiting
        until = time.monotonic() + REPLY  # after that it is not done any more: the page was told so
        self._channel.post({**message, "pressed": list(self.switches.pressed), "until": until})
        try:
            return await asyncio.wait_for(waiting, REPLY)
        except TimeoutError:
            self._replies.pop(str(message["id"]), None)
            return f"the control process did not answer within {REPLY:g} s, and will not do it later: try again"

    async def press(self, name: str) -> float | None:
        """Hold, stop or halt; ms until the loop had seen it, None when no loop looked: none ran. Pressed even where the
        station is gone, which nobody can be sure of for a moment."""
        began, runs = time.monotonic(), self.picture["run"] is not None
        {"hold": self.switches.hold, "stop": self.switches.stop, "halt": self.switches.halt}[name]()
        if self._channel is not None:
            self._channel.offer({"act": name})  # wakes a station that waits; the switch is what counts
        pressed = self.switches.pressed
        while (now := time.monotonic()) - began < SEEN:
            if self.switches.seen == pressed:
                return round(1e3 * (now - began), 3) if runs else None
            await asyncio.sleep(LOOK)
        return None

    async def close(self, patience: float) -> bool:
        """Have the station let go of its bench and end; False when it had not within `patience` s."""
        if self._channel is not None and self.alive:
            self._asked_to_end = True
            self._channel.post({"act": "close"})
        give_up = time.monotonic() + patience
        while self._process is not None and self._process.poll() is None:
            if time.monotonic() > give_up:
                return False
            await asyncio.sleep(0.02)
        return True

    def release(self) -> None:
        """The page of switches goes; whoever still runs keeps what is mapped."""
        self.switches.unlink()
