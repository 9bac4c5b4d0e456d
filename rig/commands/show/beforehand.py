"""What a verb says before a rig is shown: refusals and dry runs, with --json as the events they would be later."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterable, Iterator

from rig.commands.show.show import showing
from rig.core.errors import Exit, HdrigError


@contextlib.contextmanager
def refusing(json: bool) -> Iterator[None]:
    """A refusal that no event has told is one with `json`: a program that reads lines always reads an `exit`."""
    try:
        yield
    except HdrigError as error:
        if json and not error.told:
            with showing(json):
                raise
        raise


def refuse(sentence: str) -> None:
    """A wrong command line, before anything could be made of it, as an event."""
    with showing(json=True) as show:
        show.leave(Exit.USAGE, sentence)


def foretell(json: bool, lines: Iterable[str], check: Callable[[], None] = lambda: None) -> int:
    """A dry run: its lines on stdout, or as `said`; then the `check`, which may refuse what they tell. Exit code 0."""
    if not json:
        print("\n".join(lines))
        check()
        return 0
    with showing(json) as show:
        for line in lines:
            show.say(line)
        check()
        return show.leave(0)
