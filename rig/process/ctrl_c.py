"""Ctrl-C and a service manager's stop outside of a session: KeyboardInterrupt, but not in the middle of an import.

Raised there it is lost in a callback of the import system, or leaves half a module behind, which shows as an error of
another kind. So it waits until the import is done. Raised again while a program says that it was interrupted, it would
be a traceback. So it is raised only where somebody catches it. In a session `rig.process.interrupts` takes over.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from types import FrameType
from typing import Any, final

from rig.core.errors import Exit, HdrigError

MACHINERY = "<frozen importlib._bootstrap"  # how names of files begin whose frames are imports
USUAL: dict[signal.Signals, Any] = {
    signal.SIGINT: signal.default_int_handler,
    signal.SIGTERM: signal.SIG_DFL,
}  # Python by itself
AGAIN = 0.02  # s until it is tried again: no person notices, and an import takes longer


@final
class Ears:
    """SIGINT and SIGTERM as KeyboardInterrupt while `act` runs, after the import that one falls into; without an `act`
    wherever they come. One that comes outside of `act` waits for it, and is let go where it is over.

    Raised in a callback of a library in C it may be lost, and show as an error of that library's: an error nobody
    foresaw that comes after an interrupt is taken for it. Raised where Python itself lets nothing out, as in what is
    called when an object goes, it comes again.
    """

    def __init__(self, act: Callable[..., Any] | None) -> None:
        self._act = getattr(act, "__code__", None)
        self._came: list[int] = []
        self._raised = False
        self._over = False
        self._told: Callable[[sys.UnraisableHookArgs], Any] = sys.unraisablehook

    def hear(self, signum: int, frame: FrameType | None) -> None:
        """What SIGINT and SIGTERM call."""
        if importing(frame) or not self._acting(frame):
            self._wait(signum)
            return
        self._raised = True
        raise KeyboardInterrupt

    def again(self, signum: int, frame: FrameType | None) -> None:
        """What SIGALRM calls: to whoever handles it by now, for a session counts it. Once `act` is over to nobody."""
        came = self._came.pop()
        if not self._over:
            signal.raise_signal(came)

    def let_go(self) -> None:
        """Nothing that waits is raised from here on: it came before handlers change, and is not for the next ones."""
        self._over = True

    def let_out(self, lost: sys.UnraisableHookArgs) -> None:
        """What Python calls with an error that it lets nowhere."""
        if self._raised and lost.exc_type is KeyboardInterrupt:
            self._wait(signal.SIGINT)
            return
        self._told(lost)

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        """While active, an interrupt that a library made another error of is one again."""
        try:
            yield
        except Exception as error:
            if self._raised and not isinstance(error, HdrigError):
                raise KeyboardInterrupt from error
            raise

    def _wait(self, signum: int) -> None:
        self._came.append(signum)
        signal.setitimer(signal.ITIMER_REAL, AGAIN)

    def _acting(self, frame: FrameType | None) -> bool:
        """True when `frame` is of `act`, or of what it called. Asked of where the program is: a mark set at the end of
        `act` would be set too late for a signal just before it."""
        return self._act is None or any(one.f_code is self._act for one in callers(frame))


@contextlib.contextmanager
def after_imports(
    act: Callable[..., Any] | None = None, then: Callable[[int, FrameType | None], Any] = signal.default_int_handler
) -> Iterator[Ears]:
    """While active, signals are heard by the `Ears` of `act`; `then` hears SIGINT after it. A signal that is not
    Python's own to handle, and in another thread than the main one all, are left as they are."""
    ears = Ears(act)
    ours = threading.current_thread() is threading.main_thread()
    mine = [number for number, usual in USUAL.items() if ours and signal.getsignal(number) is usual]
    if not mine:
        yield ears
        return
    alarm = signal.signal(signal.SIGALRM, ears.again)
    told, sys.unraisablehook = sys.unraisablehook, ears.let_out
    for number in mine:
        signal.signal(number, ears.hear)
    try:
        with ears.kept():
            yield ears
    finally:
        ears.let_go()
        for number in mine:
            signal.signal(number, then if number is signal.SIGINT else USUAL[number])
        signal.setitimer(signal.ITIMER_REAL, 0.0)  # from here nobody sets it: the alarm may be given back
        signal.signal(signal.SIGALRM, alarm)
        sys.unraisablehook = told


def leave(signum: int, frame: FrameType | None) -> None:
    """The end at once and without a traceback, of a program that has said its last word and written all it had."""
    os._exit(int(Exit.HALTED))


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
    return any(one.f_code.co_filename.startswith(MACHINERY) for one in callers(frame))


def callers(frame: FrameType | None) -> Iterator[FrameType]:
    """`frame`, what called it, what called that, up to the first."""
    while frame is not None:
        yield frame
        frame = frame.f_back
