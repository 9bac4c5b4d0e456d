"""Which act is done, and how often: once per id, on the present revision, by the page that holds control.

What this says of stop and halt only a page is told: whoever asks for one gets it, see `desk`.
"""

from __future__ import annotations

import uuid
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from rig.console.bodies import wrong_of_act
from rig.station.rules import ACTS, ALWAYS

REMEMBERED = 500  # ids: a page that repeats itself does so within seconds
CONTROL = "take_control"


@dataclass(frozen=True)
class Answer:
    """What a POST gets."""

    status: int
    body: dict[str, Any]

    @classmethod
    def yes(cls, seen_by_loop_ms: float | None = None) -> Answer:
        """Accepted."""
        return cls(200, {"accepted": True, "seen_by_loop_ms": seen_by_loop_ms})

    @classmethod
    def no(cls, why: str) -> Answer:
        """Refused with a sentence."""
        return cls(409, {"accepted": False, "why": why})


@dataclass
class Gate:
    """No input, no output: what may pass. `revision` counts what an act can be based on."""

    revision: int = 1
    controller: str | None = None  # id of the page that holds control; None: the next one that acts gets it
    _answers: OrderedDict[str, tuple[object, Answer]] = field(default_factory=OrderedDict)  # by id: to which act

    def before(self, asked: Mapping[str, Any]) -> Answer | None:
        """The answer an id got before, a refusal where that was to another act; None for an id not seen yet."""
        act, answer = self._answers.get(str(asked.get("id")), (None, None))
        return answer if answer is None or act == asked.get("act") else self.used(act)

    @staticmethod
    def used(act: object) -> Answer:
        """The refusal to an id that came with another `act` before."""
        return Answer.no(f"this id was that of another act, '{act}': every act needs an id of its own, a UUID")

    def remember(self, asked: Mapping[str, Any], answer: Answer) -> Answer:
        """An id is answered once and for all."""
        self._answers[str(asked["id"])] = (asked.get("act"), answer)
        while len(self._answers) > REMEMBERED:
            self._answers.popitem(last=False)
        return answer

    def refuse(self, asked: Mapping[str, Any], page: str, allowed: Mapping[str, bool | str]) -> str:
        """Why an act does not pass, one sentence; "" when it does. `allowed` is what the rules say of now."""
        act = asked.get("act")
        if not isinstance(act, str) or act not in (*ACTS, CONTROL):
            return f"there is no act '{str(act)[:60]}'; expected one of {', '.join((*ACTS, CONTROL))}"
        if not _is_id(asked.get("id")):
            return "an act needs an id of its own: 'id', a UUID"
        if act in ALWAYS and (act != "hold" or self.holds(page)):
            return ""
        wrong = wrong_of_act(act, asked)
        if wrong or act == CONTROL:
            return wrong
        if not self.holds(page):
            return "another page holds control: take it first; stop and halt work from every page"
        if "based_on" not in asked:
            return f"an act needs 'based_on', the revision of the state it was decided on; it is {self.revision}"
        if asked["based_on"] != self.revision:
            return (
                f"the state has changed since this page last saw it (revision {str(asked['based_on'])[:20]}, it is "
                f"{self.revision}): look again, then decide"
            )
        why = allowed.get(act, "it is not known whether that can be done now")
        return "" if why is True else str(why)

    def holds(self, page: str) -> bool:
        """Whether `page` may act; nobody's control may be had by anybody."""
        return self.controller is None or self.controller == page

    def take(self, page: str) -> None:
        """`page` holds control from here."""
        if self.controller != page:
            self.controller = page

    def release(self, page: str) -> None:
        """A page that is gone holds nothing."""
        if self.controller == page:
            self.controller = None

    def passed(self) -> int:
        """Something changed that acts are based on; the new revision."""
        self.revision += 1
        return self.revision


def _is_id(given: object) -> bool:
    if not isinstance(given, str) or len(given) > 64:
        return False
    try:
        uuid.UUID(given)
    except ValueError:
        return False
    return True
