"""The process between the ring of a run and the viewer: it looks, sends, drops; nobody ever waits for it.

It is told what to follow by lines of JSON on stdin, {"follow": FOLDER}, and ends when stdin does. Its first line on
stdout says {"url": …} once the viewer listens, or {"error": …}.
"""

from __future__ import annotations

import json
import os
import select
import threading
import time
from collections.abc import Callable
from pathlib import Path

from rig.core.errors import NotReady
from rig.live.view.about import About
from rig.live.view.canvas import Canvas
from rig.live.view.feed import Feed
from rig.live.view.rerun_canvas import Gone, RerunCanvas, Stalled
from rig.live.view.scene import Scene
from rig.live.view.server import Server

BEAT = 0.1  # s: of the 30 s that curves show it is 2 px or 3; a block costs the same whether it has 50 rows or 100
CHECK = 0.5  # s between looks whether the viewer takes what it is sent
PROBE = 1.0  # s between looks at one that does not: the SDK keeps a note of each
PATIENCE = 0.25  # s such a look may last; what a frozen viewer is sent between two looks is 0.1 MB
LAST_WORD = 0.3  # s for the last rows of all


class Commands:
    """Lines on a file descriptor, read without waiting longer than asked."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._rest = b""
        self.closed = False

    def wait(self, seconds: float) -> list[str]:
        """Folders to follow that were named within `seconds`; comes back sooner when one was."""
        if not select.select([self._descriptor], [], [], seconds)[0]:
            return []
        new = os.read(self._descriptor, 65536)
        self.closed = not new
        *lines, self._rest = (self._rest + new).split(b"\n")
        return [folder for line in lines if (folder := _folder(line))]


class Bridge:
    """Follows the newest folder it was told of, on a viewer that may be slow, frozen or killed at any time."""

    def __init__(self, server: Server, clock: Callable[[], float] = time.monotonic) -> None:
        self._server, self._clock = server, clock
        self._scene: Scene | None = None
        self._canvas: RerunCanvas | None = None
        self.heard = True  # the viewer takes what it is sent; while it does not, nothing is kept for it
        self._checked = clock()

    @property
    def skipped(self) -> int:
        """Rows of the present run this process was too slow for."""
        return self._scene.feed.skipped if self._scene else 0

    def run(self, commands: Commands) -> None:
        """Until stdin ends."""
        while not commands.closed:
            began = self._clock()
            for folder in commands.wait(0.0):
                self.follow(Path(folder))
            self.beat()
            spent = self._clock() - began
            for folder in commands.wait(max(BEAT - spent, 0.001)):
                self.follow(Path(folder))
        self._last_word()

    def follow(self, folder: Path) -> None:
        """This run from now on; what is left of the one before is shown first."""
        if self._scene is not None:
            self._scene.step(self.heard)
            self._scene.feed.close()
        self._scene = Scene(Feed(folder), self._open)

    def beat(self) -> None:
        """One look at the ring, and now and then one at the viewer."""
        if self._scene is not None:
            self._scene.step(self.heard)
        now = self._clock()
        if now - self._checked >= (CHECK if self.heard else PROBE):
            self._checked = now
            self._look()

    def _look(self) -> None:
        """Is the viewer there, and does it take what it is sent?"""
        if self._canvas is None:
            return
        if not self._server.runs:
            self._raise_the_dead()
            return
        try:
            self._canvas.flush(PATIENCE)
        except Stalled:
            self.heard = False
        except Gone:
            self._renew()
        else:
            self.heard = True

    def _raise_the_dead(self) -> None:
        if not self._server.wanted:  # a window that was closed
            self.heard = False
            return
        try:
            self._server.start()
        except NotReady:
            self.heard = False  # tried again at the next look
            return
        self._renew()

    def _renew(self) -> None:
        self.heard = True
        if self._scene is not None:
            self._scene.renew()

    def _open(self, about: About) -> Canvas:
        """A stream of its own for every run, and a new one where the old one lost its viewer: it finds no other."""
        if self._canvas is not None:  # saying goodbye to a dead viewer can take seconds
            threading.Thread(target=self._canvas.close, daemon=True).start()
        self._canvas = RerunCanvas.to_viewer(about, self._server.url)
        return self._canvas

    def _last_word(self) -> None:
        if self._canvas is None or not self.heard:
            return
        if self._scene is not None:
            self._scene.step(True)
        try:
            self._canvas.flush(LAST_WORD)
        except (Stalled, Gone):
            return


def _folder(line: bytes) -> str:
    try:
        said = json.loads(line)
    except ValueError:
        return ""
    folder = said.get("follow") if isinstance(said, dict) else None
    return folder if isinstance(folder, str) else ""
