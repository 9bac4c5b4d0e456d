"""Ctrl-C and a service manager's stop outside of a session: KeyboardInterrupt, but not in the middle of an import.

Raised there it is lost in a callback of the import system, or leaves half a module behind, which shows as an error of
another kind. So it waits until the import is done. In a session `rig.process.interrupts` takes over.
"""

from __future__ import annotations

import contextlib
import signal
import sys
import threading
from collections.abc import Iterator
from types import FrameType
from typing import Any

from rig.core.errors import HdrigError

MACHINERY = "<frozen importlib._bootstrap"  # how names of files begin whose frames are imports
USUAL: dict[signal.Signals, Any] = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
}  # Python by itself
AGAIN = 0.02  # s until it is tried again: no person notices, and an import takes longer


@contextlib.contextmanager
def after_imports() -> Iterator[None]:
    """While active, SIGINT and SIGTERM raise KeyboardInterrupt, after the import that one falls into. A signal that is
    not Python's own to handle, and in another thread than the main one all, are left as they are.

    Raised in a callback of a library in C it may be lost, and show as an error of that library's: an error nobody
    foresaw that comes after an interrupt is taken for it. Raised where Python itself lets nothing out, as in what is
    called when an object goes, it comes again.
    """
    ours = threading.current_thread() is threading.main_thread()
    mine = [number for number, usual in USUAL.items() if ours and signal.getsignal(number) is usual]
    if not mine:
        yield
        return
    came: list[int] = []
    raised = False

    def wait(signum: int) -> None:
        came.append(signum)
        signal.setitimer(signal.ITIMER_REAL, AGAIN)

    def interrupt(signum: int, frame: FrameType | None) -> None:
        nonlocal raised
        if importing(frame):
            wait(signum)
            return
        raised = True
        raise KeyboardInterrupt

    def let_out(lost: sys.UnraisableHookArgs) -> None:
        if raised and lost.exc_type is KeyboardInterrupt:
            wait(signal.SIGINT)
            return
        told(lost)

    def again(signum: int, frame: FrameType | None) -> None:
        signal.raise_signal(came.pop())  # to whoever handles it by now: a session counts it

    alarm = signal.signal(signal.SIGALRM, again)
    told, sys.unraisablehook = sys.unraisablehook, let_out
    for number in mine:
        signal.signal(number, interrupt)
    try:
        yield
    except Exception as error:
        if raised and not isinstance(error, HdrigError):
            raise KeyboardInterrupt from error
        raise
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number in mine:
            signal.signal(number, USUAL[number])
        signal.signal(signal.SIGALRM, alarm)
        sys.unraisablehook = told


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """While active, SIGINT and SIGTERM wait, and are raised when it is over: for files that belong together. In another
    thread than the main one nothing changes."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = {number: signal.signal(number, lambda signum, frame: came.append(signum)) for number in USUAL}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if came:
            signal.raise_signal(came[0])


@contextlib.contextmanager
def deaf() -> Iterator[None]:
    """While active, a Ctrl-C waits, and processes that are begun inherit that for good: it is for the main process to
    handle. One that says so itself, once it has begun, would die of it before, with a traceback."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def importing(frame: FrameType | None) -> bool:
    """True when `frame` runs because something is being imported."""
    while frame is not None:
        if frame.f_code.co_filename.startswith(MACHINERY):
            return True
        frame = frame.f_back
    return False
