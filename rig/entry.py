"""The command `hdrig` from its first instant: what it imports itself, Python has loaded already or nearly so."""

from __future__ import annotations

import os
import signal
import sys
from types import FrameType

HALTED = 130  # as in rig.core.errors, which is not there yet


def main() -> int:
    """The exit code of `rig.cli.main`; a Ctrl-C before that hears it ends in a line too, and not in a traceback."""
    usual = signal.getsignal(signal.SIGINT)
    if usual is not signal.default_int_handler:  # somebody has said what is to become of it
        return _run()
    signal.signal(signal.SIGINT, leave)
    try:
        return _run()
    except KeyboardInterrupt:  # between two who hear it
        return leave(signal.SIGINT, None)


def leave(signum: int, frame: FrameType | None) -> int:
    """The end at once: nothing was begun."""
    os.write(2, b"hdrig: interrupted\n")
    os._exit(HALTED)


def _run() -> int:
    import rig.cli

    if signal.getsignal(signal.SIGINT) is leave:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return rig.cli.main()


if __name__ == "__main__":
    sys.exit(main())
