"""What the operator sees while a run goes on: rig time, time left, peak-to-peak so far. On stderr."""

from __future__ import annotations

import math
import sys
import time
from types import TracebackType
from typing import Any

from rig.core.sample import Sample

ARCSEC = math.pi / 180 / 3600
REDRAW = 0.1  # s of wall time between two pictures
TURN = 2 * math.pi


class LivePeakToPeak:
    """Kinematic error θ̃ = θ_m/N − θ_l, peak to peak over the last whole motor turn, from the samples seen so far."""

    def __init__(self, ratio: float) -> None:
        self.ratio = ratio
        self.value: float | None = None  # rad at the output
        self._turn: int | None = None
        self._entered = 0  # which way this turn was entered: +1, -1; 0 for the first, which began somewhere inside
        self._low = self._high = 0.0

    def add(self, sample: Sample) -> None:
        """One more sample. Only a turn passed through one way counts: a reversal adds its own offset."""
        error, turn = sample.theta_m / self.ratio - sample.theta_l, math.floor(sample.theta_m / TURN)
        if turn != self._turn:
            way = 0 if self._turn is None else (1 if turn > self._turn else -1)
            if way and way == self._entered:
                self.value = self._high - self._low
            self._entered, self._turn = way, turn
            self._low = self._high = error
        self._low, self._high = min(self._low, error), max(self._high, error)

    def __str__(self) -> str:
        return "p-p –" if self.value is None or math.isnan(self.value) else f"p-p {self.value / ARCSEC:.1f} arcsec"


class Progress:
    """A bar on a terminal; on anything else a plain line every tenth of the run."""

    def __init__(self, title: str, duration: float, ratio: float) -> None:
        self.title, self.duration = title, duration
        self.peak = LivePeakToPeak(ratio)
        self.t = 0.0
        self._began = self._drawn = time.monotonic()
        self._tenth = 0
        self._bar: Any = None

    def __enter__(self) -> Progress:
        if sys.stderr.isatty():
            self._bar = _bar(self.title, self.duration)
            self._bar.start()
        else:
            print(f"{self.title}: {self.duration:.0f} s of rig time", file=sys.stderr)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._show()
            self._bar.stop()

    def watch(self, sample: Sample) -> None:
        """One sample now and then, from the loop."""
        self.peak.add(sample)
        self.t = sample.t
        if self._bar is None:
            self._line()
            return
        now = time.monotonic()
        if now - self._drawn >= REDRAW:
            self._drawn = now
            self._show()

    def _show(self) -> None:
        left = ""
        if self.t > 0:
            left = f"{max(self.duration - self.t, 0.0) * (time.monotonic() - self._began) / self.t:.0f} s left"
        self._bar.update(0, completed=min(self.t, self.duration), peak=str(self.peak), left=left)

    def _line(self) -> None:
        tenth = int(10 * self.t / self.duration)
        if tenth > self._tenth:
            self._tenth = tenth
            print(f"{self.title}: {self.t:6.1f} of {self.duration:.1f} s, {self.peak}", file=sys.stderr)


def _bar(title: str, duration: float) -> Any:
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn
    from rich.progress import Progress as RichProgress
    from rich.table import Column

    def text(form: str) -> TextColumn:
        return TextColumn(form, table_column=Column(no_wrap=True))  # a number broken over two lines can be misread

    bar = RichProgress(
        text("{task.description}"),
        BarColumn(bar_width=12),  # all of it fits into 80 columns
        text("rig time {task.completed:.1f}/{task.total:.1f} s"),
        text("{task.fields[left]}"),
        text("{task.fields[peak]}"),
        console=Console(stderr=True),
        auto_refresh=False,
    )
    bar.add_task(title, total=duration, peak="", left="")
    return _Refreshing(bar)


class _Refreshing:
    """Draws only when told: no second thread beside the loop."""

    def __init__(self, bar: Any) -> None:
        self.bar = bar
        self.start, self.stop = bar.start, bar.stop

    def update(self, task: int, **fields: Any) -> None:
        self.bar.update(task, **fields)
        self.bar.refresh()
