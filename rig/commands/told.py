"""What a command found among many runs: lines for people or JSON for programs, and a page where one is asked for."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Protocol, TypeVar

from rig.commands.list_ import say
from rig.runfile.writing import writing


class Findable(Protocol):
    """Something that can be told to programs."""

    def as_json(self) -> dict[str, Any]:
        """As its schema says."""


F = TypeVar("F", bound=Findable)


def tell(
    found: F, args: argparse.Namespace, lines: Callable[[F], Sequence[str]], write: Callable[[Path, F], None]
) -> int:
    """By the options `--json` and `--html` in `args`; the exit code. `write` makes the page."""
    if args.json:
        print(json.dumps(found.as_json(), allow_nan=False, indent=1))
    else:
        for line in lines(found):
            say(line)
    if args.html is not None:
        with writing(args.html, "--html"):
            write(args.html, found)
        if not args.json:
            print(f"page {args.html}")
    return 0
