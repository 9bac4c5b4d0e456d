r"""Ctrl-C once = stop, twice = halt, Ctrl-\ = halt, at any moment of a session; a hold is asked for apart. Looked at
every tick.

A key asks for each by name; asking for a stop twice is not a halt then.
"""

from __future__ import annotations

import signal
from types import FrameType, TracebackType
from typing import Any

from rig.core.errors import Exit


class Interrupts:
    r"""While active, SIGINT, SIGTERM and SIGHUP are counted, not raised: 1 = stop (category 1), 2 or more = halt.

    SIGQUIT is a halt by itself: who presses Ctrl-\ wants an end at once, and a program that dies of it would leave the
    torque on.
    """

    SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)

    def __init__(self) -> None:
        self._heard: list[int] = []  # signals, SIGQUIT twice: appended in one step, which no handler comes between
        self._stop_key = self._halt_key = False  # only ever set: by any thread or handler, no request can be lost
        self.held = False  # somebody asked for the motor to be held; a stop asked for later goes before
        self._before: dict[signal.Signals, Any] = {}

    @property
    def count(self) -> int:
        """1 stop, 2 or more halt."""
        signals = len(self._heard)  # nobody has pressed a key at nearly every tick
        return max(signals, self._keyed) if self._stop_key or self._halt_key else signals

    @count.setter
    def count(self, value: int) -> None:
        self._heard = [0] * value

    @property
    def _keyed(self) -> int:
        """1 stop, 2 halt, by a key."""
        return 2 if self._halt_key else int(self._stop_key)

    @property
    def signalled(self) -> bool:
        """Whether a signal asked for an end, not a key."""
        return bool(self._heard)

    @property
    def exit(self) -> Exit:
        """What the command ends with when this is why: stopped, halted, or PASS when nobody asked."""
        return (Exit.PASS, Exit.STOPPED, Exit.HALTED)[min(self.count, 2)]

    @property
    def who(self) -> str:
        """Who asked, for a sentence that says that something was ended."""
        return "by the operator"

    def request(self, signum: int = 0, frame: FrameType | None = None) -> None:
        """One more request to end, by a signal."""
        self._heard.extend((signum, signum) if signum == signal.SIGQUIT else (signum,))

    def hold(self) -> None:
        """Bring the motor to rest and hold it there, torque on; what a key calls."""
        self.held = True

    def let_hold_go(self) -> bool:
        """A run is accepted: a hold asked for while nothing ran is over. True when there was one that is."""
        asked, self.held = self.held, False
        return asked and not self.held  # the page's lasts as long as the act it was pressed in

    def stop(self) -> None:
        """What a key calls; asked for twice it is still a stop, and after a halt it is none."""
        self._stop_key = True

    def halt(self) -> None:
        """What a key calls: torque off at once."""
        self._halt_key = True

    def __enter__(self) -> Interrupts:
        for sig in self.SIGNALS:
            self._before[sig] = signal.signal(sig, self.request)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for sig, handler in self._before.items():
            signal.signal(sig, handler)
