r"""Hold, stop and halt by a key while a rig is worked on; the terminal as it was on every way out.

A thread sleeps in `select` until a key is pressed and then only counts: the loop looks at the counts every tick, so a
halt is one tick away, and a loop that nobody types at is never disturbed.

| key | what it asks for |
|---|---|
| h | hold: to rest, held there, torque on (category 2) |
| s | stop: to rest, then torque off (category 1) |
| any other | halt: torque off at once (category 0); somebody in a panic presses whatever key is nearest |
| Ctrl-C | stop, a second time halt |
| Ctrl-\ | halt |
| Ctrl-Z | while the motor is energised a stop: a program that sleeps cannot guard it; else what it always is |

In a run that relies on no loop, as the proof of the signs, hold and stop take the torque off at once.

What a terminal sends by itself is no key: answers to what some program asked of it, focus, the mouse. That it is gone
is told by a signal.
"""

from __future__ import annotations

import contextlib
import os
import re
import select
import signal
import sys
import termios
import threading
import time
import tty
from collections.abc import Callable, Iterator
from types import FrameType, TracebackType
from typing import Any, final

from rig.process.interrupts import Interrupts

LOOK = 0.5  # s between two looks whether this program has come to the foreground again
WHOLE = 0.05  # s within which the rest of a sequence comes that a line cut in two
AT_ONCE = 4096  # bytes
UNASKED = re.compile(  # what a terminal sends by itself
    rb"""\x1b\[ (?: [?>=] [0-9;:]* \$? [A-Za-z]  # what it is, its modes, its colours
                | [0-9;:]* \$ y | [03] n | [0-9;]+ t  # a mode, its state, its size
                | (?!1;\d+R) [0-9]+ ; [0-9]+ R  # where the cursor is; in the first row that is Shift-F3 as well, a key
                | [IO]  # focus
                | < [0-9;]+ [Mm] | [0-9]+ ; [0-9]+ ; [0-9]+ M | M [^\x1b]{3} )  # the mouse
      | \x1b [\]P_^X] [^\x07\x1b]* (?: \x07 | \x1b\\ )  # a text: colours, a name, what a terminal can""",
    re.VERBOSE | re.DOTALL,
)
PART = re.compile(  # of a sequence, at the end of what was read; Esc alone is a key and waits for nothing
    rb"\x1b (?: \[ (?: [<?>=]? [0-9;:]* \$? | M [^\x1b]{0,2} ) | [\]P_^X] [^\x07\x1b]* \x1b? ) \Z",
    re.VERBOSE | re.DOTALL,
)
IGNORED = (signal.SIGTTIN, signal.SIGTTOU)  # the shell's ways of stopping a program in the background, motor or not


@final
class Keys:
    """While active, on a terminal, keys ask `interrupts`. Anywhere else only Ctrl-Z does, which comes as a signal: from
    a terminal that something else is read from, or from whoever sends it.

    `energised` says whether torque may be on. Enter and leave in the main thread: signals are handled there.
    """

    def __init__(self, interrupts: Interrupts, energised: Callable[[], bool]) -> None:
        self._energised = energised
        self._hold, self._stop, self._halt = interrupts.hold, interrupts.stop, interrupts.halt
        self._terminal: int | None = None
        self._modes: list[Any] = []  # of the terminal, as it was
        self._listening = True
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> Keys:
        self._before[signal.SIGTSTP] = signal.signal(signal.SIGTSTP, self._suspend)
        try:
            terminal = sys.stdin.fileno()
            self._modes = termios.tcgetattr(terminal)
        except (AttributeError, OSError, ValueError, termios.error):  # no terminal
            return self
        self._terminal = terminal
        self._woken, self._wake = os.pipe()
        for quiet in IGNORED:
            self._before[quiet] = signal.signal(quiet, signal.SIG_IGN)
        self._before[signal.SIGCONT] = signal.signal(signal.SIGCONT, self._resume)
        self._take()
        self._thread = threading.Thread(target=self._listen, name="keys", daemon=True)
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        heard = self._terminal is not None
        if heard:
            os.write(self._wake, b"!")
            self._thread.join()
            self._give()
            self._terminal = None
        for sig, handler in self._before.items():
            signal.signal(sig, handler)
        if heard:
            os.close(self._wake)
            os.close(self._woken)

    @contextlib.contextmanager
    def paused(self) -> Iterator[None]:
        """The terminal by lines and with echo, for a question; what was typed before it is no answer to it."""
        if self._terminal is None:
            yield
            return
        self._listening = False
        self._nudge()
        self._give()
        termios.tcflush(self._terminal, termios.TCIFLUSH)
        try:
            yield
        finally:
            self._take()
            self._listening = True
            self._nudge()

    def _listen(self) -> None:
        terminal = self._terminal
        assert terminal is not None
        while True:
            here = self._listening and self._foreground()
            patience = None if here or not self._listening else LOOK
            ready, _, _ = select.select([terminal, self._woken] if here else [self._woken], [], [], patience)
            if self._woken in ready and os.read(self._woken, 1) == b"!":
                return
            if terminal in ready and self._listening and not self._read(terminal):
                return
            if not here and self._listening and self._foreground():
                self._take()

    def _read(self, terminal: int) -> bool:
        """What was typed, asked for; False when the terminal is gone."""
        try:
            came = typed = os.read(terminal, AT_ONCE)
            give_up = time.monotonic() + WHOLE  # for all parts together: a key held down is no rest of anything
            while came and PART.search(typed) and self._more(terminal, give_up):
                came = os.read(terminal, AT_ONCE)
                typed += came
        except OSError:  # in the background meanwhile, or hung up
            return self._foreground()
        self._ask(UNASKED.sub(b"", typed).lower())
        return bool(came)

    @staticmethod
    def _more(terminal: int, give_up: float) -> bool:
        return bool(select.select([terminal], [], [], max(0.0, give_up - time.monotonic()))[0])

    def _ask(self, keys: bytes) -> None:
        """For what was typed at once; a halt goes before a stop, and a stop before a hold."""
        if keys.strip(b"hs"):  # another key, or the bytes of one
            self._halt()
        elif b"s" in keys:
            self._stop()
        elif keys:
            self._hold()

    def _nudge(self) -> None:
        """Have the thread look anew."""
        os.write(self._wake, b".")

    def _foreground(self) -> bool:
        """Whether the terminal is ours to read."""
        try:
            return self._terminal is not None and os.tcgetpgrp(self._terminal) == os.getpgrp()
        except OSError:
            return False

    def _take(self) -> None:
        """Keys as they are pressed, without echo; Ctrl-C stays a signal, Ctrl-S and Ctrl-Q are keys."""
        if self._terminal is not None and self._foreground():
            with contextlib.suppress(termios.error):
                tty.setcbreak(self._terminal, termios.TCSANOW)
                modes = termios.tcgetattr(self._terminal)
                modes[tty.IFLAG] &= ~termios.IXON
                modes[tty.LFLAG] &= ~termios.IEXTEN
                termios.tcsetattr(self._terminal, termios.TCSANOW, modes)

    def _give(self) -> None:
        """The terminal as it was."""
        if self._terminal is not None and self._foreground():
            with contextlib.suppress(termios.error):
                termios.tcsetattr(self._terminal, termios.TCSANOW, self._modes)

    def _suspend(self, signum: int, frame: FrameType | None) -> None:
        """Ctrl-Z."""
        if self._energised():
            self._stop()
            return
        self._give()
        signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGTSTP)  # sleeps here until fg
        signal.signal(signal.SIGTSTP, self._suspend)
        self._take()  # where there is no shell to sleep under, it did not

    def _resume(self, signum: int, frame: FrameType | None) -> None:
        """fg, after Ctrl-Z or after a SIGSTOP that nobody can catch: the shell has made the terminal its own."""
        if self._listening:
            self._take()
            self._nudge()
