"""The live view for whoever runs the rig: started before the run, told of folders, closed after; it cannot hold up."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Any

from rig.core.errors import NotReady

READY_WITHIN = 25.0  # s: three processes and, the first time, the viewer's files; 1.5 s on a quiet machine
GONE_WITHIN = 1.2  # s to say the last rows and end; then it is killed, frozen or not


class Viewer:
    """A handle on the bridge's process. A context manager; nothing here waits for the viewer once it was started."""

    def __init__(self, kind: str) -> None:
        """`kind`: "web" or "native". Start it before the loop pins or schedules itself. Raises NotReady."""
        command = [sys.executable, "-m", "rig.live.view", kind]
        try:
            self._process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, process_group=0
            )
        except OSError as error:
            raise NotReady(f"the live view cannot be started: {error.strerror}") from error
        assert self._process.stdin is not None
        os.set_blocking(self._process.stdin.fileno(), False)
        try:
            said = self._first_line()
        except BaseException:  # a Ctrl-C while it starts
            self.close()
            raise
        self.url = str(said.get("url", ""))  # of the page; "" for a window
        self.viewer_pid = int(said.get("viewer", 0))
        if "error" in said:
            self.close()
            raise NotReady(str(said["error"]))

    @property
    def pid(self) -> int:
        """Of the bridge."""
        return self._process.pid

    @property
    def runs(self) -> bool:
        """True while the bridge lives."""
        return self._process.poll() is None

    def follow(self, folder: Path) -> None:
        """Show this run from now on. Never waits; a bridge that is gone or frozen does not hear it."""
        assert self._process.stdin is not None
        line = json.dumps({"follow": str(folder.absolute())}).encode() + b"\n"
        with contextlib.suppress(OSError):
            os.write(self._process.stdin.fileno(), line)

    def close(self) -> None:
        """The last rows are shown, then everything of the view is gone, in 2 s at most. Idempotent."""
        for pipe in (self._process.stdin, self._process.stdout):
            if pipe is not None:
                with contextlib.suppress(OSError):
                    pipe.close()
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(GONE_WITHIN)
        self._process.kill()  # the viewer goes with its parent
        self._process.wait()

    def __enter__(self) -> Viewer:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _first_line(self) -> dict[str, Any]:
        """What the bridge says of itself; {"error": …} when it says nothing."""
        assert self._process.stdout is not None
        said, give_up = b"", time.monotonic() + READY_WITHIN
        while not said.endswith(b"\n") and time.monotonic() < give_up:
            if select.select([self._process.stdout], [], [], 0.1)[0]:
                new = os.read(self._process.stdout.fileno(), 4096)
                if not new:
                    break
                said += new
        try:
            return dict(json.loads(said))
        except ValueError:
            return {"error": f"the live view did not start within {READY_WITHIN:.0f} s"}
