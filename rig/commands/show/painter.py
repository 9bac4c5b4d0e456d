"""The process that draws: events in on stdin, a line each, until there are no more.

It lives in a session of its own: signals of the terminal are for the loop. Should the loop's process die without a
word, it gives the terminal back its echo.
"""

from __future__ import annotations

import contextlib
import errno
import json
import os
import signal
import sys
import termios

from rig.commands.show.enrich import Enriched
from rig.commands.show.screens import screen_for
from rig.process.streams import show_what_fits


def main() -> None:
    """`painter HOW [TERMINAL]`, HOW as in `screens`, TERMINAL the number of an open file: that which keys come from,
    and without it none do."""
    how, *terminal = sys.argv[1:]
    for quiet in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT):
        signal.signal(quiet, signal.SIG_IGN)  # it ends when its pipe does, so that the last words are seen
    show_what_fits(sys.stdout)
    try:
        screen = Enriched(screen_for(how, sys.stdout, keyed=bool(terminal)))
        for line in sys.stdin.buffer:
            screen.take(json.loads(line))
        screen.close()
    except (OSError, ValueError) as lost:  # nobody looks any more
        if isinstance(lost, OSError) and lost.errno != errno.EPIPE:
            print(f"hdrig: what was to be printed could not be written: {lost}", file=sys.stderr)
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        for _ in sys.stdin.buffer:  # or the loop would meet a closed pipe
            pass
    finally:
        for number in terminal:
            with contextlib.suppress(termios.error):
                give_back(int(number))


def give_back(terminal: int) -> None:
    """Lines, echo and Ctrl-S, as a shell wants them. Raises termios.error when it is no terminal any more."""
    modes = termios.tcgetattr(terminal)
    if not modes[3] & termios.ICANON:
        modes[0] |= termios.IXON
        modes[3] |= termios.ICANON | termios.ECHO | termios.IEXTEN
        termios.tcsetattr(terminal, termios.TCSANOW, modes)


if __name__ == "__main__":
    main()
