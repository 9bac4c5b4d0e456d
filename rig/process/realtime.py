"""What the operating system grants a loop that must not be late; asked for while a run lasts, given back after it."""

from __future__ import annotations

import contextlib
import ctypes
import gc
import os
from types import TracebackType

PRIORITY = 50  # of 1 to 99: above everything ordinary, below the kernel's own threads that serve the bus
MCL_CURRENT, MCL_FUTURE = 1, 2  # mlockall: what is in memory, and what will be
PR_SET_TIMERSLACK, PR_GET_TIMERSLACK = 29, 30  # prctl: how late a sleep may end so that others can be woken with it
SLACK = 1  # ns instead of 50 000; only ordinary scheduling looks at it


class RealTime:
    """First-in-first-out scheduling, locked memory, no timer slack, no garbage collection. `granted` says what came.

    Use as a context manager in the thread of the loop. Nothing here raises: what is refused is said instead.
    """

    def __init__(self) -> None:
        self.granted = ""
        self._policy: tuple[int, os.sched_param] | None = None
        self._before = 0  # ns, timer slack; 0: not known
        self._collects = True
        self._libc = ctypes.CDLL(None, use_errno=True)

    def __enter__(self) -> RealTime:
        granted = [self._schedule(), self._lock(), self._slack()]
        self._collects = gc.isenabled()
        gc.collect()
        gc.freeze()
        gc.disable()
        self.granted = ", ".join(granted)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._collects:
            gc.enable()
        gc.unfreeze()
        if self._before > 0:
            self._libc.prctl(PR_SET_TIMERSLACK, self._before, 0, 0, 0)
        self._libc.munlockall()
        if self._policy is not None:
            with contextlib.suppress(OSError):
                os.sched_setscheduler(0, *self._policy)

    def _schedule(self) -> str:
        before = os.sched_getscheduler(0), os.sched_getparam(0)
        try:
            # children (the recorder) must not inherit it: a process that flushes files has no business up there
            os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(PRIORITY))
        except OSError:
            return "ordinary scheduling (FIFO refused)"
        self._policy = before
        return f"FIFO {PRIORITY}"

    def _lock(self) -> str:
        if self._libc.mlockall(MCL_CURRENT | MCL_FUTURE):
            return "memory not locked"
        return "memory locked"

    def _slack(self) -> str:
        self._before = int(self._libc.prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0))
        if self._libc.prctl(PR_SET_TIMERSLACK, SLACK, 0, 0, 0):
            return "timer slack as it was"
        return f"timer slack {SLACK} ns"
