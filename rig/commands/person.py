"""The person at the terminal as operator: told in a sentence, heard by the Enter key."""

from __future__ import annotations

import select
import sys

from rig.core.errors import Exit, HdrigError, NotReady
from rig.core.operator import Change, Operator
from rig.interrupts import Interrupts

LOOK = 0.2  # s between two looks at Ctrl-C


class NotMade(HdrigError):
    """The person ended it instead."""

    def __init__(self, sentence: str, exit: Exit) -> None:
        super().__init__(sentence)
        self.exit = exit


class Person(Operator):
    """Prompts on stderr, reads stdin. `interrupts` counts Ctrl-C meanwhile."""

    def __init__(self, interrupts: Interrupts) -> None:
        self.interrupts = interrupts

    def make(self, change: Change) -> None:
        """Raises NotReady without a terminal or when the person says no, NotMade after Ctrl-C."""
        if not sys.stdin.isatty():
            raise NotReady(f"nobody can be asked to {change.words()}: standard input is no terminal")
        print(f"\nthe motor is without torque. Now {change.words()}.", file=sys.stderr)
        print("Enter when it is done, n and Enter when it cannot be: ", end="", file=sys.stderr, flush=True)
        if self._answer().strip().lower().startswith("n"):
            raise NotReady(f"the operator could not do this: {change.words()}")

    def again(self, why: str) -> bool:
        """Ask whether a change that could not be shown is made once more."""
        if not sys.stdin.isatty():
            return False
        print(f"\n{why}", file=sys.stderr)
        print("Enter to do it once more, n and Enter to end here: ", end="", file=sys.stderr, flush=True)
        return not self._answer().strip().lower().startswith("n")

    def _answer(self) -> str:
        while not select.select([sys.stdin], [], [], LOOK)[0]:
            if self.interrupts.count:
                raise NotMade("stopped by the operator, asked for a change by hand", self.interrupts.exit)
        line = sys.stdin.readline()
        if not line:
            raise NotReady("standard input was closed before the change was made")
        return line
