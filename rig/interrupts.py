"""Ctrl-C once = stop, twice = halt, at any moment of a session; the loop looks once a tick."""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any

from rig.core.errors import Exit


class Interrupts:
    """While active, SIGINT, SIGTERM and SIGHUP are counted, not raised: 1 = stop (category 1), 2 or more = halt."""

    SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

    def __init__(self) -> None:
        self.count = 0
        self._before: dict[signal.Signals, Any] = {}

    @property
    def exit(self) -> Exit:
        """What the command ends with when this is why: stopped, halted, or PASS when nobody asked."""
        return (Exit.PASS, Exit.STOPPED, Exit.HALTED)[min(self.count, 2)]

    def request(self, signum: int = 0, frame: FrameType | None = None) -> None:
        """One more request to end; also what a button calls."""
        self.count += 1

    def __enter__(self) -> Interrupts:
        for sig in self.SIGNALS:
            self._before[sig] = signal.signal(sig, self.request)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for sig, handler in self._before.items():
            signal.signal(sig, handler)
