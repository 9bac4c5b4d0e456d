"""The person at the terminal as operator: told in a sentence, heard by the Enter key."""

from __future__ import annotations

import contextlib
import select
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

from rig.core.errors import Ended, NotReady
from rig.core.operator import Change, ClearFault, Operator
from rig.process.interrupts import Interrupts

LOOK = 0.2  # s between two looks at Ctrl-C


def aloud(text: str) -> None:
    """On stderr."""
    print(text, file=sys.stderr, flush=True)


class Person(Operator):
    """Asks by `ask`, reads stdin by lines: `quiet` keeps whoever else reads it away meanwhile.

    `interrupts` counts Ctrl-C meanwhile.
    """

    def __init__(
        self,
        interrupts: Interrupts,
        ask: Callable[[str], None] = aloud,
        quiet: Callable[[], AbstractContextManager[None]] = contextlib.nullcontext,
    ) -> None:
        self.interrupts, self.ask, self.quiet = interrupts, ask, quiet

    def make(self, change: Change) -> None:
        """Raises NotReady without a terminal or when the person says no, Ended after Ctrl-C."""
        if not sys.stdin.isatty():
            raise NotReady(f"nobody can be asked to {change.words()}: standard input is no terminal")
        words = change.words()
        told = f"Now {words}." if not isinstance(change, ClearFault) else f"Before that {words}."
        said = f"the motor is without torque. {told}"
        answer = self._answer(f"{said}\nEnter when it is done, n and Enter when it cannot be:")
        if answer.strip().lower().startswith("n"):
            raise NotReady(f"the operator could not do this: {change.words()}")

    def again(self, why: str) -> bool:
        """Ask whether a change that could not be shown is made once more."""
        if not sys.stdin.isatty():
            return False
        answer = self._answer(f"{why}\nEnter to do it once more, n and Enter to end here:")
        return not answer.strip().lower().startswith("n")

    def _answer(self, question: str) -> str:
        with self.quiet():
            self.ask(f"\n{question}")
            while not select.select([sys.stdin], [], [], LOOK)[0]:
                if self.interrupts.count:
                    raise Ended("stopped by the operator, asked for a change by hand", self.interrupts.exit)
            line = sys.stdin.readline()
        if not line:
            raise NotReady("standard input was closed before the change was made")
        return line
