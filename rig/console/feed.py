"""The live samples: one reader of the run's ring for all pages, each page a short queue that drops the oldest."""

from __future__ import annotations

import time
from collections import deque
from pathlib import Path
from typing import Any, final

import numpy as np

from rig.console.columns import LAYOUT, Rows, frame, of_reading, of_run
from rig.console.link import Link
from rig.console.sofar import SoFar
from rig.core.errors import HdrigError
from rig.live.envelope import envelope
from rig.live.tail import Tail

PAIRS = 250.0  # min-max pairs a second a page gets at most
QUEUE = 10  # frames a page may be behind: half a second, then the oldest go


@final
class Feed:
    """`step` 20 times a second. A page is a deque from `join`; what it is too slow for falls out at the other end."""

    def __init__(self, link: Link) -> None:
        self._link = link
        self._tail: Tail | None = None
        self._ring = ""
        self._pages: list[deque[bytes]] = []
        self.so_far: SoFar | None = None
        self.newest = time.monotonic()  # s, when the newest sample came

    def join(self) -> deque[bytes]:
        """A page that wants frames."""
        queue: deque[bytes] = deque(maxlen=QUEUE)
        self._pages.append(queue)
        return queue

    def leave(self, queue: deque[bytes]) -> None:
        """And wants them no more."""
        self._pages = [other for other in self._pages if other is not queue]

    def step(self) -> None:
        """Read what there is, hand it out."""
        self._follow()
        block, skipped = (self._of_idle(), 0) if self._tail is None else self._of_ring(self._tail)
        if len(block):
            self.newest = time.monotonic()
            made = frame(block, skipped)
            for queue in self._pages:
                queue.append(made)

    @property
    def age_ms(self) -> float:
        """Since the newest sample came."""
        return 1e3 * (time.monotonic() - self.newest)

    def _follow(self) -> None:
        """The ring of the run there is now, or none."""
        run = self._link.picture["run"]
        ring = run["ring"] if run else ""
        if ring == self._ring:
            return
        if self._tail is not None:
            self._hand_out_rest(self._tail)
            self._tail.close()
        self._tail, self._ring = None, ring
        if ring:
            self.so_far = SoFar(self._ratio())
            try:
                self._tail = Tail(Path(ring))
            except HdrigError:  # a run so short that it is over already
                return

    def _hand_out_rest(self, tail: Tail) -> None:
        block, skipped = self._of_ring(tail)
        if len(block):
            for queue in self._pages:
                queue.append(frame(block, skipped))

    def _of_ring(self, tail: Tail) -> tuple[Rows, int]:
        rows = tail.read()
        if self.so_far is None or not len(rows):
            return np.empty(0, LAYOUT), tail.skipped
        told = self.so_far.add(rows)
        block = of_run(rows, self.so_far.ratio, self.so_far.zero or 0.0)
        block["kinematic_error"][~told] = np.nan
        return envelope(block, self._every(rows)), tail.skipped

    def _every(self, rows: Rows) -> int:
        """Rows behind one pair: as many as keep a page at 250 pairs a second of wall time, whatever the clock."""
        pairs = PAIRS / 20.0
        return max(int(np.ceil(len(rows) / pairs)), 1)

    def _of_idle(self) -> Rows:
        waiting = self._link.idle
        found = [of_reading(waiting.popleft()) for _ in range(len(waiting))]
        return np.concatenate(found) if found else np.empty(0, LAYOUT)

    def _ratio(self) -> float:
        bench = self._link.picture["bench"]
        return float(bench["ratio"]) if bench else 1.0

    def figures(self) -> dict[str, Any]:
        """Of the run so far, for State.run."""
        so_far, run = self.so_far, self._link.picture["run"]
        if so_far is None or run is None or run["ring"] != self._ring:  # not yet followed
            return {"t": 0.0, "peak_to_peak_arcsec": None, "rms_following_deg": None}
        return {
            "t": so_far.newest,
            "peak_to_peak_arcsec": so_far.peak_to_peak,
            "rms_following_deg": so_far.following,
        }
