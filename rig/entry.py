"""The command `hdrig` from its first instant: what it imports itself, Python has loaded already."""

from __future__ import annotations

import _signal  # type: ignore[import-not-found]  # `signal` itself imports as long as Python starts
import os
import sys

HALTED = 130  # as in rig.core.errors, which is not there yet


def main() -> int:
    """The exit code of `rig.cli.main`; a Ctrl-C before that hears it ends in a line too, and not in a traceback."""
    if _signal.getsignal(_signal.SIGINT) is not _signal.default_int_handler:  # somebody has said what becomes of it
        return _run()
    _signal.signal(_signal.SIGINT, leave)
    try:
        return _run()
    except KeyboardInterrupt:  # between two who hear it
        leave(_signal.SIGINT, None)
        return HALTED


def leave(signum: int, frame: object) -> None:
    """The end at once: nothing was begun."""
    os.write(2, b"hdrig: interrupted\n")
    os._exit(HALTED)


def _run() -> int:
    import rig.cli

    if _signal.getsignal(_signal.SIGINT) is leave:
        _signal.signal(_signal.SIGINT, _signal.default_int_handler)
    return rig.cli.main()


if __name__ == "__main__":
    sys.exit(main())
