"""Events to whoever draws them. The loop never waits for a terminal: a stopped one (Ctrl-S) or a full pipe holds up the
process that draws, not the one that turns the motor.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import select
import subprocess
import sys
import time
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping
from typing import Any, TextIO, final

from rig.commands.show.enrich import Enriched
from rig.commands.show.screens import screen_for

Event = Mapping[str, Any]
PATIENCE = 2.0  # s for the last lines to be drawn; then the drawing is given up
BACKLOG = 1000  # events kept for a process that does not take them; progress is not kept at all


class Outlet(ABC):
    """Where events go."""

    @abstractmethod
    def put(self, event: Event) -> None:
        """Hand over one event. Never waits, never raises."""

    @abstractmethod
    def settle(self) -> None:
        """Give what was put the time to be seen."""

    @abstractmethod
    def close(self) -> None:
        """Nothing is put any more; everything is drawn. Idempotent."""


@final
class Here(Outlet):
    """Drawn at once, where there is no file a process could write to: standard error of a test, of a notebook."""

    def __init__(self, how: str, stream: TextIO) -> None:
        self._screen = Enriched(screen_for(how, stream))

    def put(self, event: Event) -> None:
        """Drawn before it returns."""
        self._screen.take(dict(event))

    def settle(self) -> None:
        """Nothing to wait for: what was put is seen."""
        return  # it is seen

    def close(self) -> None:
        """The screen's own end."""
        self._screen.close()


@final
class Apart(Outlet):
    """Drawn by a process of its own, fed through a pipe that is never waited for."""

    def __init__(self, how: str, out: int) -> None:
        # a number of its own: 0 is the pipe over there
        terminal = [os.dup(sys.stdin.fileno())] if _is_terminal(sys.stdin) else []
        self._process = subprocess.Popen(
            [sys.executable, "-m", "rig.commands.show.painter", how, *map(str, terminal)],
            stdin=subprocess.PIPE,
            stdout=out,
            pass_fds=terminal,
            start_new_session=True,  # Ctrl-C and Ctrl-Z are for us; it ends when we do
        )
        for number in terminal:
            os.close(number)
        assert self._process.stdin is not None
        self._pipe = self._process.stdin.fileno()
        os.set_blocking(self._pipe, False)
        self._waiting: deque[bytes] = deque()
        self._gone = False

    def put(self, event: Event) -> None:
        """Queued for the pipe, in order; progress is dropped while others wait, anything once BACKLOG events do."""
        if self._waiting and (event["event"] == "progress" or len(self._waiting) >= BACKLOG):
            self._pump()
            return
        self._waiting.append(json.dumps(event).encode() + b"\n")
        self._pump()

    def _pump(self) -> None:
        """What the pipe takes now."""
        try:
            while self._waiting:
                line = self._waiting[0]
                written = os.write(self._pipe, line)
                if written < len(line):
                    self._waiting[0] = line[written:]
                else:
                    self._waiting.popleft()
        except BlockingIOError:
            return
        except OSError:  # whoever drew is gone; the run is not
            self._waiting.clear()

    def settle(self) -> None:
        """Waits 50 ms of wall time for the other process."""
        time.sleep(0.05)

    def close(self) -> None:
        """Waits at most PATIENCE s for what is queued to be taken and drawn."""
        if self._gone:
            return
        self._gone = True
        give_up = time.monotonic() + PATIENCE
        while self._waiting and (left := give_up - time.monotonic()) > 0:
            select.select([], [self._pipe], [], left)
            self._pump()
        with contextlib.suppress(OSError):
            self._process.stdin.close()  # type: ignore[union-attr]
        try:
            self._process.wait(max(give_up - time.monotonic(), 0.1))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def outlet(json: bool) -> Outlet:
    """For the streams this process has."""
    stream = sys.stdout if json else sys.stderr
    stream.flush()
    how = "json" if json else "screen" if _is_terminal(stream) else "lines"
    try:
        return Apart(how, stream.fileno())
    except (io.UnsupportedOperation, OSError, ValueError, AttributeError):
        return Here(how, stream)


def _is_terminal(stream: TextIO) -> bool:
    try:
        return stream is not None and stream.isatty()
    except ValueError:  # closed
        return False
