"""Ctrl-C outside of a session: KeyboardInterrupt, but not in the middle of an import.

Raised there it is lost in a callback of the import system, or leaves half a module behind, which shows as an error of
another kind. So it waits until the import is done. In a session `rig.interrupts` takes over.
"""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator
from types import FrameType

MACHINERY = "<frozen importlib._bootstrap"  # how names of files begin whose frames are imports
AGAIN = 0.02  # s until it is tried again: no person notices, and an import takes longer


@contextlib.contextmanager
def after_imports() -> Iterator[None]:
    """While active, an interrupt that falls into an import is raised after it. Where SIGINT is not Python's own to
    handle, or in another thread than the main one, nothing changes.
    """
    ours = threading.current_thread() is threading.main_thread()
    if not ours or signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        yield
        return
    alarm = signal.signal(signal.SIGALRM, _again)
    signal.signal(signal.SIGINT, _interrupt)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGALRM, alarm)


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """While active, an interrupt waits, and is raised when it is over: for files that belong together. In another
    thread than the main one nothing changes."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = signal.signal(signal.SIGINT, lambda signum, frame: came.append(signum))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
        if came:
            signal.raise_signal(signal.SIGINT)


def importing(frame: FrameType | None) -> bool:
    """True when `frame` runs because something is being imported."""
    while frame is not None:
        if frame.f_code.co_filename.startswith(MACHINERY):
            return True
        frame = frame.f_back
    return False


def _interrupt(signum: int, frame: FrameType | None) -> None:
    if importing(frame):
        signal.setitimer(signal.ITIMER_REAL, AGAIN)
        return
    raise KeyboardInterrupt


def _again(signum: int, frame: FrameType | None) -> None:
    signal.raise_signal(signal.SIGINT)  # to whoever handles it by now: a session counts it
