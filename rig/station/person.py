"""The person at the page as operator: told in a prompt, heard by its answer. The sensors have to show it as ever."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from typing import final

from rig.core.errors import Ended, NotReady
from rig.core.operator import Change, ClearFault, Operator
from rig.station.interrupts import Panel
from rig.station.telling import Teller


@final
class PagePerson(Operator):
    """Asks the page; where the rig has a `hand` of its own, the twin's, that makes the change once it said yes."""

    def __init__(self, teller: Teller, panel: Panel, attend: Callable[[], None], hand: Operator | None) -> None:
        self._teller, self._panel, self._attend, self._hand = teller, panel, attend, hand
        self.begins_anew = hand is not None and hand.begins_anew
        self._answer: bool | None = None
        self.asked: Change | None = None  # last

    def make(self, change: Change) -> None:
        """Raises NotReady when the answer is no or nobody can give one, Ended after a stop."""
        self.asked = change
        if not self.ask(change.words(), type(change).__name__):
            raise NotReady(f"the operator could not do this: {change.words()}")
        if not isinstance(change, ClearFault):
            self.remake(change)

    def remake(self, change: Change) -> None:
        """By the rig's own hand, if it has one."""
        if self._hand is not None:
            self._hand.make(change)

    def ask(self, text: str, what: str) -> bool:
        """Yes or no to `text`. Raises as `make`."""
        status, self._answer = self._teller.status, None
        status.prompt = {"id": uuid.uuid4().hex, "text": text, "what": what}
        self._teller.tell()
        try:
            with self._panel.unwatched():
                self._wait(text)
        finally:
            status.prompt = None
            self._teller.tell()
        return bool(self._answer)

    def _wait(self, text: str) -> None:
        while self._answer is None:
            self._attend()
            if self._panel.count:
                raise Ended(f"stopped {self._panel.who}; asked was: {text}", self._panel.exit)
            if self._teller.channel.closed:
                raise NotReady(f"the page's server is gone, nobody can be asked: {text}")

    def answer(self, prompt_id: str, done: bool) -> str:
        """What a page said; why it is not taken, or ""."""
        prompt = self._teller.status.prompt
        if prompt is None or prompt["id"] != prompt_id:
            return "that question is not asked any more"
        self._answer = done
        return ""
